// stopline-replay: turns a recording into a page for the browser.
#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "base/input_error.h"
#include "common/command_line.h"
#include "common/program.h"
#include "experiment/output.h"
#include "replay/page.h"
#include "scenario/quantity.h"

namespace {

using namespace stopline;

struct ReplayOptionsOfUser {
    std::string file;
    std::string output;
    std::string from;
    std::string until;
};

void declare(CLI::App& app, ReplayOptionsOfUser& options) {
    add_version_option(app);
    app.add_option("FILE", options.file, "Recording, written by stopline-run --record")->required();
    app.add_option("--output", options.output, "Page to write (default: FILE with .html)")->type_name("PAGE");
    app.add_option("--from", options.from, "Leave out what was before this time, but for the rest of its minute")
        ->type_name("TIME");
    app.add_option("--until", options.until, "Leave out what was after this time, but for the rest of its minute")
        ->type_name("TIME");
    app.footer(std::string(
                   "\nExamples:\n"
                   "  stopline-run scenarios/grid.yaml --set 'duration=1200 s' --record out/grid.rec\n"
                   "  stopline-replay out/grid.CDG.rec\n"
                   "  stopline-replay out/grid.CDG.rec --from '600 s' --until '900 s' --output out/gridlock.html\n\n") +
               kExitCodesText);
}

double seconds_of(const char* option, const std::string& text, double otherwise) {
    if (text.empty()) return otherwise;
    const ParsedQuantity time = parse_quantity(text, unit("s"));
    if (!time.problem.empty()) throw InputError(fmt::format("{}: value '{}' {}", option, text, time.problem));
    return time.si;
}

ExitCode run(const ReplayOptionsOfUser& options) {
    ReplayWindow window;
    window.from_s = seconds_of("--from", options.from, window.from_s);
    window.until_s = seconds_of("--until", options.until, window.until_s);
    if (window.until_s < window.from_s) {
        throw InputError(fmt::format("--until: '{}' is before --from '{}'", options.until, options.from));
    }
    RecordingReader reader(options.file);
    const ReplayPage page = make_replay_page(reader, window, [](std::int64_t) { return !interrupted(); });
    const std::filesystem::path output = options.output.empty()
                                             ? std::filesystem::path(options.file).replace_extension(".html").string()
                                             : options.output;
    write_file(output, page.html);
    fmt::print("{}: {} frames from {:g} to {:g} s, up to {} vehicles, {:.2f} MB\n", output.string(), page.frames,
               page.from_s, page.to_s, page.most_present, static_cast<double>(page.html.size()) * 1e-6);
    fmt::print(
        "\nNext: open it in a browser; it needs no network. Space plays, a click on a vehicle shows its state.\n");
    return ExitCode::done;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program("stopline-replay", [&] {
        CLI::App app("Turns a recording into one HTML page: vehicles on the network, lights, a time-space diagram.",
                     "stopline-replay");
        ReplayOptionsOfUser options;
        declare(app, options);
        const std::optional<ExitCode> end = parse_command_line(app, argc, argv);
        return end ? *end : run(options);
    });
}

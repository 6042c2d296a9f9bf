// stopline-replay: turns a recording into an HTML page for the browser.
#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/command_files.h"
#include "base/io/output.h"
#include "common/command_line.h"
#include "common/examples.h"
#include "common/program.h"
#include "replay/page.h"
#include "scenario/schema/quantity.h"

namespace {

using namespace stopline;

struct ReplayCliOptions {
    std::string file;
    std::string output;
    std::string from;
    std::string until;
};

void declare(Options& app, ReplayCliOptions& options) {
    app.add("FILE", options.file, "Recording, written by stopline-run --record").required();
    app.add("--output", options.output, "Page to write (default: FILE with the extension .html)").type_name("PAGE");
    app.add("--from", options.from,
            "Start of the page in simulated time, rounded down to about a minute (default: start of the recording)")
        .type_name("TIME");
    app.add("--until", options.until,
            "End of the page in simulated time, rounded up to about a minute (default: end of the recording)")
        .type_name("TIME");
    app.footer(
        runnable("\nExamples:\n"
                 "  stopline-run scenarios/grid.yaml --set 'duration=1200 s' --record out/grid.rec\n"
                 "  stopline-replay out/grid.CDG.rec\n"
                 "  stopline-replay out/grid.CDG.rec --from '600 s' --until '900 s' --output out/gridlock.html\n\n"
                 "Next: open the page in a browser. It needs no network.\n\n") +
        kExitCodesText);
}

double time_or_default_s(const char* option, const std::string& text, double default_s) {
    if (text.empty()) return default_s;
    const ParsedQuantity time = parse_quantity(text, unit("s"));
    if (!time.problem.empty()) throw InputError(fmt::format("{}: value '{}' {}", option, text, time.problem));
    return time.si;
}

ExitCode run(const ReplayCliOptions& options) {
    ReplayWindow window;
    window.from_s = time_or_default_s("--from", options.from, window.from_s);
    window.until_s = time_or_default_s("--until", options.until, window.until_s);
    if (window.until_s < window.from_s) {
        throw InputError(
            fmt::format("--until: '{}' is before --from '{}'; give a later time", options.until, options.from));
    }
    const std::filesystem::path output = options.output.empty()
                                             ? std::filesystem::path(options.file).replace_extension(".html").string()
                                             : options.output;
    CommandFiles files;
    files.add_input(options.file, "the recording");
    files.add_output(output, "--output");
    RecordingReader reader(options.file);
    prepare_output_file(output);
    const ReplayPage page = make_replay_page(reader, window, [](std::int64_t) { return !interrupted(); });
    write_file(output, page.html);
    fmt::print("{}: {} frames from {:g} to {:g} s, up to {} vehicles, {:.2f} MB\n", output.string(), page.frames,
               page.from_s, page.to_s, page.max_present, static_cast<double>(page.html.size()) * 1e-6);
    fmt::print("\nNext: open it in a browser (it needs no network)\n  file://{}\n",
               std::filesystem::absolute(output).lexically_normal().string());
    fmt::print("The space bar starts and stops the animation; a click on a vehicle shows its state.\n");
    return ExitCode::done;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program("stopline-replay", [&] {
        Options app("Turns a recording into one HTML page with moving vehicles, signals and a time-space diagram.",
                    "stopline-replay");
        ReplayCliOptions options;
        declare(app, options);
        const std::optional<ExitCode> end = app.parse(argc, argv);
        return end ? *end : run(options);
    });
}

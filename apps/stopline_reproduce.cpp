// stopline-reproduce: the whole paper from one command, and one page that says how well it was met.
#include <filesystem>
#include <string>

#include <fmt/core.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/input_error.h"
#include "common/command_line.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "report/report.h"
#include "report/reproduce.h"
#include "scenario/load_scenario.h"

namespace {

using namespace stopline;

struct ReproduceOptionsOfUser {
    std::string section = "all";
    std::string output;
    int threads = 0;
    bool quick = false;
};

void declare(CLI::App& app, ReproduceOptionsOfUser& options) {
    app.add_option("--section", options.section,
                   fmt::format("Section of the paper: {} (default: all)", fmt::join(known_sections(), ", ")))
        ->type_name("S");
    app.add_flag(
        "--quick", options.quick,
        "A first look within minutes: fewer combinations, shorter runs (data/paper/quick.csv); marked as reduced");
    app.add_option("--output", options.output, "Folder of the report (default: out/paper; --quick: out/paper_quick)")
        ->type_name("DIR");
    app.add_option("--threads", options.threads, "Threads to use (default: all); results do not depend on it")
        ->check(CLI::Range(1, 1024))
        ->type_name("N");
    add_version_option(app);
    app.footer(
        std::string(
            "\nWhat is finished is kept in the folder of the report. Started again after an interrupt, a kill or a power cut,\n"
            "the same command runs what is missing and writes the same bytes.\n\n"
            "Examples:\n"
            "  stopline-reproduce --quick\n"
            "  stopline-reproduce\n"
            "  stopline-reproduce --section IV --output out/section_iv\n\n"
            "Next: open index.html of that folder in a browser; it needs no network.\n\n") +
        kExitCodesText);
}

std::string command_of(const ReproduceOptionsOfUser& options) {
    return fmt::format("stopline-reproduce{}{}", options.section == "all" ? "" : " --section " + options.section,
                       options.quick ? " --quick" : "");
}

std::vector<JobEnd> run_with_progress(ReproduceOptions options) {
    ProgressBar bar("");
    options.on_progress = [&bar](const ReproduceProgress& progress) {
        return bar.update(progress.share, progress.doing, progress.left_s);
    };
    options.on_message = [&bar](const std::string& line) {
        bar.clear();
        fmt::print("{}\n", line);
        std::fflush(stdout);
    };
    return run_jobs(options);
}

ExitCode run(const ReproduceOptionsOfUser& user) {
    ReproduceOptions options;
    options.section = user.section;
    if (user.quick) options.reductions = Reductions::load(data_directory() / "paper" / "quick.csv");
    options.folder = !user.output.empty() ? user.output : user.quick ? "out/paper_quick" : "out/paper";
    options.threads = threads_or_all(user.threads);
    const std::vector<JobEnd> jobs = run_with_progress(options);
    const ReportContent content = write_report(options, jobs, command_of(user));
    const Scorecard& scorecard = content.scorecard;
    fmt::print("\n{}{} rows of the paper: {} inside their tolerance, {} outside, {} open\n",
               content.reduced() ? "REDUCED: " : "", scorecard.rows.size(), scorecard.count(Verdict::inside),
               scorecard.count(Verdict::miss), scorecard.count(Verdict::open));
    fmt::print("\nWritten to {}\n  index.html\n  figures/  SVG and PNG\n  tables/   CSV\n", options.folder.string());
    fmt::print("\nNext: open this page in a browser\n  file://{}\n",
               std::filesystem::absolute(options.folder / "index.html").lexically_normal().string());
    for (const std::string& problem : content.problems) fmt::print(stderr, "stopline-reproduce: failed: {}\n", problem);
    if (!content.problems.empty()) fmt::print(stderr, "The same command tries again what failed.\n");
    double violations = 0.0;
    for (const JobEnd& end : jobs) violations += static_cast<double>(end.output.violations);
    if (violations > 0.0) {
        fmt::print(stderr,
                   "stopline-reproduce: overlaps, entries on red or lost vehicles in the runs behind the report\n");
    }
    return content.problems.empty() && violations == 0.0 ? ExitCode::done : ExitCode::check_failed;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program("stopline-reproduce", [&] {
        CLI::App app(
            "Runs what is missing of the whole paper and writes a report: the scorecard, every figure, all tables.",
            "stopline-reproduce");
        ReproduceOptionsOfUser options;
        declare(app, options);
        const std::optional<ExitCode> end = parse_command_line(app, argc, argv);
        return end ? *end : run(options);
    });
}

// stopline-reproduce: repeats all experiments of the paper and writes a report that compares our results with the
// paper.
#include <filesystem>
#include <string>

#include <fmt/core.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/input_error.h"
#include "base/io/console.h"
#include "base/io/data_directory.h"
#include "common/command_line.h"
#include "common/examples.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "paper/headlines.h"
#include "paper/report/report.h"
#include "paper/report/reproduce.h"

namespace {

using namespace stopline;

struct ReproduceCliOptions {
    std::string section = "all";
    std::string output;
    int threads = 0;
    bool quick = false;
};

void declare(Options& app, ReproduceCliOptions& options) {
    app.add("--section", options.section,
            fmt::format("Section of the paper to reproduce: {} (default: all)", fmt::join(known_sections(), ", ")))
        .type_name("S");
    app.add_flag(
        "--quick", options.quick,
        "First look within minutes: fewer combinations and shorter runs, marked as reduced (data/paper/quick.csv)");
    app.add("--output", options.output, "Folder for the report (default: out/paper; with --quick: out/paper_quick)")
        .type_name("DIR");
    app.add("--threads", options.threads, "Number of threads (default: all processors). Results do not depend on it")
        .range(1, 1024)
        .type_name("N");
    app.footer(
        runnable(
            "\nFinished experiments are kept in the folder of the report. After an interruption, the same command\n"
            "continues with the missing ones; the final report is the same.\n\n"
            "Examples:\n"
            "  stopline-reproduce --quick\n"
            "  stopline-reproduce\n"
            "  stopline-reproduce --section IV --output out/section_iv\n\n"
            "Next: open index.html in the folder of the report with a browser. It needs no network.\n\n") +
        kExitCodesText);
}

std::string command_of(const ReproduceCliOptions& options) {
    return fmt::format("stopline-reproduce{}{}", options.section == "all" ? "" : " --section " + options.section,
                       options.quick ? " --quick" : "");
}

std::vector<JobResult> run_with_progress(ReproduceOptions options) {
    ProgressBar bar("");
    options.on_progress = [&bar](const ReproduceProgress& progress) {
        return bar.update(progress.share, progress.job, progress.remaining_s);
    };
    options.on_message = [&bar](const std::string& line) {
        bar.clear();
        fmt::print("{}\n", line);
        std::fflush(stdout);
    };
    return run_jobs(options);
}

ExitCode run(const ReproduceCliOptions& user) {
    ReproduceOptions options;
    options.section = user.section;
    if (user.quick) options.reductions = Reductions::load(data_directory() / "paper" / "quick.csv");
    print_warnings(options.reductions.warnings());
    options.folder = !user.output.empty() ? user.output : user.quick ? "out/paper_quick" : "out/paper";
    options.threads = thread_count(user.threads);
    const std::vector<JobResult> jobs = run_with_progress(options);
    const ReportContent content = write_report(options, jobs, command_of(user));
    const Scorecard& scorecard = content.scorecard;
    print_warnings(scorecard.warnings);
    fmt::print("\n{}{}\n", content.reduced() ? "REDUCED: " : "", results_text(scorecard));
    fmt::print("\nWritten to {}\n  index.html\n  figures/  SVG and PNG\n  tables/   CSV\n", options.folder.string());
    fmt::print("\nNext: open the report in a browser\n  file://{}\n",
               std::filesystem::absolute(options.folder / "index.html").lexically_normal().string());
    for (const std::string& problem : content.problems) print_message("stopline-reproduce: failed: {}\n", problem);
    if (!content.problems.empty()) print_message("Repeat the command to try the failed parts again.\n");
    double violations = 0.0;
    for (const JobResult& end : jobs) violations += static_cast<double>(end.output.violations);
    if (violations > 0.0) {
        print_message(
            "stopline-reproduce: VIOLATIONS (overlaps, entries on red or lost vehicles) in the runs of the report\n");
    }
    return content.problems.empty() && violations == 0.0 ? ExitCode::done : ExitCode::check_failed;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program("stopline-reproduce", [&] {
        Options app("Repeats the experiments of the paper and writes a report with scorecard, figures and tables.",
                    "stopline-reproduce");
        ReproduceCliOptions options;
        declare(app, options);
        const std::optional<ExitCode> end = app.parse(argc, argv);
        return end ? *end : run(options);
    });
}

// stopline-scorecard: our numbers beside those of the paper.
#include <string>

#include <fmt/core.h>
#include <fmt/format.h>

#include "common/command_line.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "common/results.h"
#include "common/text_table.h"
#include "experiment/output.h"
#include "experiment/provenance.h"
#include "experiment/scorecard.h"

namespace {

using namespace stopline;

struct ScorecardOptionsOfUser {
    CommonOptions common;
    std::string section;
    bool csv = false;
    bool strict = false;
};

void declare(CLI::App& app, ScorecardOptionsOfUser& options) {
    app.add_option("--section", options.section, "Rows of this section of the paper and below, such as III or III.E")
        ->type_name("S");
    app.add_flag("--csv", options.csv, "Print CSV instead of the table");
    app.add_flag("--strict", options.strict, "End with exit code 1 where a row misses its tolerance");
    add_common_options(app, options.common, "Folder for scorecard.csv and the measurements (default: out/scorecard)");
    app.footer(std::string("\nExamples:\n"
                           "  stopline-scorecard --section III\n"
                           "  stopline-scorecard --csv > scorecard.csv\n\n"
                           "What was measured before is used again where scenario and program are the same.\n\n") +
               kExitCodesText);
}

std::string table_text(const Scorecard& scorecard) {
    TextTable table("llllrrlrl");
    table.row({"row", "section", "quantity", "condition", "paper", "ours", "unit", "tolerance", "verdict"});
    for (const ScoredRow& row : scorecard.rows) {
        const bool claim = row.target.kind == "claim";
        const bool open = row.verdict == Verdict::open;
        std::string ours = row.ours.empty() ? "-" : row.ours;
        if (claim && !open) ours = row.verdict == Verdict::inside ? "holds" : "fails";
        table.row({row.target.id, row.target.section, row.target.quantity, row.target.condition,
                   claim ? "claim" : row.target.value, ours, claim ? "" : row.target.unit, tolerance_text(row.target),
                   to_string(row.verdict)});
    }
    return table.text("");
}

// The words of claims that were judged, and why rows miss.
std::string remarks_text(const Scorecard& scorecard) {
    constexpr std::size_t kWidth = 110;
    std::string text;
    for (const ScoredRow& row : scorecard.rows) {
        if (row.verdict == Verdict::open) continue;
        if (row.target.kind == "claim") {
            text +=
                wrapped(fmt::format("{}  paper: {}; ours: {}", row.target.id, row.target.value, row.ours), kWidth, 5);
        }
        if (row.verdict == Verdict::miss) {
            text += wrapped(fmt::format("{}  misses: {}", row.target.id, row.reason), kWidth, 5);
        }
    }
    return text.empty() ? "" : "\n" + text;
}

Scorecard score(const ScorecardOptionsOfUser& options, const std::filesystem::path& folder) {
    ScorecardOptions scorecard;
    scorecard.section = options.section;
    scorecard.folder = folder;
    if (options.common.seed) scorecard.settings = {fmt::format("seed={}", *options.common.seed)};
    scorecard.threads = threads_or_all(options.common.threads);
    ProgressBar bar("measuring");
    scorecard.on_progress = [&bar](double share) { return bar.update(share); };
    scorecard.on_message = [](const std::string& message) { fmt::print(stderr, "{}\n", message); };
    return make_scorecard(scorecard);
}

std::string command_of(const ScorecardOptionsOfUser& options) {
    std::string command = "stopline-scorecard";
    if (!options.section.empty()) command += fmt::format(" --section '{}'", options.section);
    if (options.common.seed) command += fmt::format(" --seed {}", *options.common.seed);
    return command;
}

ExitCode run(const ScorecardOptionsOfUser& options) {
    const std::filesystem::path folder = options.common.output.empty() ? "out/scorecard" : options.common.output;
    prepare_folder(folder);
    const Scorecard scorecard = score(options, folder);
    const std::string csv = scorecard_csv(scorecard);
    write_file(folder / "scorecard.csv", csv);
    const std::string provenance =
        table_provenance_json(command_of(options), "scorecard.csv", scorecard.scenario_hashes);
    write_file(folder / "scorecard.provenance.json", provenance);
    if (!options.csv) draw_all(scorecard.figures, folder);
    const int misses = scorecard.count(Verdict::miss);
    if (options.csv) {
        fmt::print("{}", csv);
    } else {
        fmt::print("{}{}\n", table_text(scorecard), remarks_text(scorecard));
        fmt::print("{} inside, {} miss, {} open\n", scorecard.count(Verdict::inside), misses,
                   scorecard.count(Verdict::open));
        fmt::print("\nNext: the table as CSV in {}; the runs behind it with tables and figures:\n{}\n",
                   (folder / "scorecard.csv").string(), fmt::join(commands_behind(scorecard.rows), "\n"));
    }
    if (scorecard.violations > 0.0) {
        fmt::print(stderr,
                   "{:.0f} violations (overlaps, entries on red, lost vehicles) in the runs behind this table\n",
                   scorecard.violations);
        return ExitCode::check_failed;
    }
    return options.strict && misses > 0 ? ExitCode::check_failed : ExitCode::done;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program("stopline-scorecard", [&] {
        CLI::App app("Puts our numbers beside those of the paper, row by row, and judges each.", "stopline-scorecard");
        ScorecardOptionsOfUser options;
        declare(app, options);
        const std::optional<ExitCode> end = parse_command_line(app, argc, argv);
        return end ? *end : run(options);
    });
}

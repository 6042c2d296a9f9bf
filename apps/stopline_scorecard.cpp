// stopline-scorecard: compares our results with the numbers of the paper.
#include <string>

#include <fmt/core.h>
#include <fmt/format.h>

#include "base/io/command_files.h"
#include "base/io/console.h"
#include "base/io/data_directory.h"
#include "base/io/output.h"
#include "common/command_line.h"
#include "common/examples.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "common/results.h"
#include "common/text_table.h"
#include "paper/results_page.h"
#include "paper/scorecard.h"
#include "runs/provenance.h"

namespace {

using namespace stopline;

struct ScorecardCliOptions {
    CommonOptions common;
    std::string section;
    std::string markdown;
    bool csv = false;
    bool strict = false;
};

void declare(Options& app, ScorecardCliOptions& options) {
    app.add("--section", options.section,
            "Only rows of this section and its subsections, such as III, III.E, coordination or energy")
        .type_name("S");
    app.add_flag("--csv", options.csv, "Print CSV instead of a table");
    app.add("--markdown", options.markdown,
            "Also write the results page to this file: one table per section, causes of deviations, findings")
        .type_name("FILE");
    app.add_flag("--strict", options.strict, "Exit with code 1 if a row is outside its tolerance");
    add_common_options(app, options.common, "Folder for scorecard.csv and the measurements (default: out/scorecard)");
    app.footer(runnable("\nExamples:\n"
                        "  stopline-scorecard --section III\n"
                        "  stopline-scorecard --csv > scorecard.csv\n"
                        "  stopline-scorecard --markdown data/paper/RESULTS.md\n\n"
                        "Stored measurements are used again if scenario and program are unchanged.\n\n"
                        "Next: the printed commands repeat the runs of a section with tables and figures.\n\n") +
               kExitCodesText);
}

std::string table_text(const Scorecard& scorecard) {
    TextTable table("llllrrlrl");
    table.add_row({"row", "section", "quantity", "condition", "paper", "ours", "unit", "tolerance", "verdict"});
    for (const ScoredRow& row : scorecard.rows) {
        const bool claim = row.target.kind == "claim";
        const bool open = row.verdict == Verdict::open;
        std::string ours = row.ours.empty() ? "-" : row.ours;
        if (claim && !open) ours = row.verdict == Verdict::inside ? "holds" : "fails";
        table.add_row({row.target.id, row.target.section, row.target.quantity, row.target.condition,
                       claim ? "claim" : row.target.value, ours, claim ? "" : row.target.unit,
                       tolerance_text(row.target), to_string(row.verdict)});
    }
    return table.text("");
}

// Returns the claims of the paper with our findings. For each result outside its tolerance, also gives the reason.
std::string remarks_text(const Scorecard& scorecard) {
    constexpr std::size_t kWidth = 110;
    std::string text;
    for (const ScoredRow& row : scorecard.rows) {
        if (row.verdict == Verdict::open) continue;
        if (row.target.kind == "claim") {
            text +=
                wrap_text(fmt::format("{}  paper: {}; ours: {}", row.target.id, row.target.value, row.ours), kWidth, 5);
        }
        if (row.verdict == Verdict::miss) {
            text += wrap_text(fmt::format("{}  misses: {}", row.target.id, row.explanation), kWidth, 5);
        }
    }
    return text.empty() ? "" : "\n" + text;
}

Scorecard score(const ScorecardCliOptions& options, const std::filesystem::path& folder) {
    ScorecardOptions scorecard;
    scorecard.section = options.section;
    scorecard.folder = folder;
    if (options.common.seed) scorecard.settings = {fmt::format("seed={}", *options.common.seed)};
    scorecard.threads = thread_count(options.common.threads);
    ProgressBar bar("measuring");
    scorecard.on_progress = [&bar](double share) { return bar.update(share); };
    scorecard.on_message = [](const std::string& message) { print_message("{}\n", message); };
    return make_scorecard(scorecard);
}

std::string command_of(const ScorecardCliOptions& options) {
    std::string command = "stopline-scorecard";
    if (!options.section.empty()) command += fmt::format(" --section '{}'", options.section);
    if (options.common.seed) command += fmt::format(" --seed {}", *options.common.seed);
    return command;
}

// Writes the results page. FINDINGS.md covers all sections, so a page of a single section does not include it.
void write_results_page(const ScorecardCliOptions& options, const Scorecard& scorecard) {
    const std::filesystem::path findings = data_directory() / "paper" / "FINDINGS.md";
    const bool append = options.section.empty() && std::filesystem::exists(findings);
    const std::string command = fmt::format("{} --markdown {}", command_of(options), options.markdown);
    write_file(options.markdown, results_markdown(scorecard, command, append ? read_file(findings) : ""));
}

// Adds all scenarios and data files to the inputs, except the results that the command may write again.
void add_shipped_inputs(CommandFiles& files) {
    for (const std::filesystem::path& folder : {data_directory(), scenario_directory()}) {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
            const std::string name = entry.path().filename();
            if (entry.is_regular_file() && name != "RESULTS.md" && !name.starts_with("scorecard.")) {
                files.add_input(entry.path(), "the shipped data");
            }
        }
    }
}

ExitCode run(const ScorecardCliOptions& options) {
    const std::filesystem::path folder = options.common.output.empty() ? "out/scorecard" : options.common.output;
    CommandFiles files;
    add_shipped_inputs(files);
    files.add_outputs(folder, {"scorecard.csv", "scorecard.provenance.json"}, "a result in the folder of --output");
    files.add_output(options.markdown, "--markdown");
    if (!options.markdown.empty()) prepare_output_file(options.markdown);
    prepare_folder(folder);
    const Scorecard scorecard = score(options, folder);
    print_warnings(scorecard.warnings);
    const std::string csv = scorecard_csv(scorecard);
    write_file(folder / "scorecard.csv", csv);
    const std::string provenance =
        table_provenance_json(command_of(options), "scorecard.csv", scorecard.scenario_hashes);
    write_file(folder / "scorecard.provenance.json", provenance);
    if (!options.markdown.empty()) write_results_page(options, scorecard);
    if (!options.csv) draw_figures(scorecard.figures, folder);
    const int misses = scorecard.count(Verdict::miss);
    if (options.csv) {
        fmt::print("{}", csv);
    } else {
        fmt::print("{}{}\n", table_text(scorecard), remarks_text(scorecard));
        fmt::print("{} inside, {} miss, {} open; {} input, {} own\n", scorecard.count(Verdict::inside), misses,
                   scorecard.count(Verdict::open), scorecard.count(Verdict::input), scorecard.count(Verdict::own));
        fmt::print("\nThe table is also in {}.\nNext: repeat the runs of these rows with tables and figures\n  {}\n",
                   (folder / "scorecard.csv").string(),
                   runnable(fmt::format("{}", fmt::join(commands_behind(scorecard.rows), "\n  "))));
    }
    if (scorecard.violations > 0.0) {
        print_message("VIOLATIONS in the runs of this table (overlaps, entries on red, lost vehicles): {:.0f}\n",
                      scorecard.violations);
        return ExitCode::check_failed;
    }
    return options.strict && misses > 0 ? ExitCode::check_failed : ExitCode::done;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program("stopline-scorecard", [&] {
        Options app("Compares our results with the numbers of the paper, row by row, and judges each.",
                    "stopline-scorecard");
        ScorecardCliOptions options;
        declare(app, options);
        const std::optional<ExitCode> end = app.parse(argc, argv);
        return end ? *end : run(options);
    });
}

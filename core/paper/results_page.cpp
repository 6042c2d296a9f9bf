#include "paper/results_page.h"

#include <array>

#include <fmt/format.h>

#include "base/io/escape.h"
#include "paper/headlines.h"
#include "paper/row_text.h"

namespace stopline {

namespace {

std::string verdict_text(Verdict verdict) {
    if (verdict == Verdict::inside) return "inside";
    if (verdict == Verdict::miss) return "**outside**";
    if (verdict == Verdict::input) return "input";
    if (verdict == Verdict::own) return "own";
    return "open";
}

std::string counts_table(const Scorecard& scorecard) {
    std::string text = "| section | results | inside | outside | open | inputs |\n|---|--:|--:|--:|--:|--:|\n";
    const auto add_line = [&](const std::string& name, const std::string& section) {
        std::array<int, 5> counts{};
        for (const ScoredRow& row : scorecard.rows) {
            if (section.empty() || main_section(row.target.section) == section) {
                ++counts.at(static_cast<std::size_t>(row.verdict));
            }
        }
        text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", name, counts[0] + counts[1] + counts[2], counts[0],
                            counts[1], counts[2], counts[3]);
    };
    for (const std::string& section : paper_sections(scorecard.rows)) add_line(section_title(section), section);
    add_line("All", "");
    return text;
}

std::string section_table(const Scorecard& scorecard, const std::string& section) {
    std::string text =
        "| row | quantity | condition | paper | ours | unit | difference | tolerance | verdict | cause of the deviation |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n";
    for (const ScoredRow& row : scorecard.rows) {
        const Target& target = row.target;
        if (main_section(target.section) != section) continue;
        text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", target.id, quantity_text(row),
                            escape_markdown_cell(target.condition), escape_markdown_cell(target.value),
                            escape_markdown_cell(row.ours), target.unit == "-" ? "" : target.unit, difference_text(row),
                            tolerance_text(target), verdict_text(row.verdict), escape_markdown_cell(row.explanation));
    }
    return text;
}

}  // namespace

std::string results_markdown(const Scorecard& scorecard, const std::string& command, const std::string& findings) {
    std::string text = fmt::format(
        "# Results\n\n"
        "A program wrote this page: `{}`. Please do not edit it.\n\n"
        "Each row is a number or a claim of the paper (`data/paper/targets.csv`). The page compares it with our value. The "
        "tolerance is ours; *max* means that the value must not be exceeded. A row is *open* if it states no tolerance or was "
        "not measured. An *own* row is a result of ours that the paper does not have (`data/paper/own_rows.csv`). `data/paper/explanations.csv` holds the causes of deviations. It also says how each row is measured; "
        "`stopline-scorecard --csv` prints that text beside the row.\n\n"
        "## The answer\n\n",
        command);
    for (const Headline& line : headlines(scorecard)) text += fmt::format("- **{}.** {}\n", line.topic, line.text);
    text += fmt::format("\n## Rows met\n\n{}", counts_table(scorecard));
    text += fmt::format("\nRuns with overlaps, entries on red or lost vehicles: {:.0f}.\n", scorecard.violations);
    for (const std::string& section : main_sections(scorecard.rows)) {
        text += fmt::format("\n## {}\n\n{}", section_title(section), section_table(scorecard, section));
    }
    if (!findings.empty()) text += "\n" + findings;
    return text;
}

}  // namespace stopline

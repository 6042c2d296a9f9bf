// Builds the HTML page of the report.
#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

#include "base/io/csv.h"
#include "base/io/escape.h"
#include "paper/headlines.h"
#include "paper/report/html.h"
#include "paper/report/page_style.h"
#include "paper/report/report.h"
#include "paper/row_text.h"
#include "runs/metrics/metric_groups.h"
#include "scenario/load_scenario.h"

namespace stopline {

namespace {

constexpr const char* kPaper =
    "Massow, Radusch and Shorten, \"On Constant Distance Spacing Policies for Cooperative Adaptive Cruise Control\" (2021)";

std::string fact(const std::string& name, const std::string& text) {
    return text.empty() ? "" : fmt::format("<dt>{}</dt><dd>{}</dd>\n", escape_html(name), escape_html(text));
}

std::string header(const ReportContent& content) {
    std::string html = "<header>\n<h1>Constant distance spacing at traffic signals: results of Stopline</h1>\n";
    html += fmt::format(
        "<p>This report reproduces {} with our own model. All numbers come from the runs, from the scenarios and from the table "
        "of the paper's numbers.</p>\n",
        escape_html(kPaper));
    if (content.reduced()) {
        html +=
            "<div class=\"reduced\"><strong>REDUCED: quick run.</strong> This report has fewer combinations, shorter runs or fewer "
            "seeds than the full reproduction (<a href=\"#repeat\">list</a>). Its numbers differ from those of the full "
            "reproduction, which runs without <code>--quick</code>. The causes of deviations refer to the full reproduction.</div>\n";
    }
    return html + "</header>\n";
}

// Figures that illustrate the main results, each given as job and file, in order of preference. The page shows the
// first three of these figures that exist.
constexpr std::array<std::pair<const char*, const char*>, 9> kAnswerPictures{{{"single_light", "counters"},
                                                                              {"comparison", "comparison"},
                                                                              {"grid_stability", "stability_1"},
                                                                              {"intersection_sweep", "turns_green_15"},
                                                                              {"grid", "network_2"},
                                                                              {"berlin", "fig26/series"},
                                                                              {"calibration_times", "differences"},
                                                                              {"arterial", "network_1"},
                                                                              {"single_light", "improvement"}}};

std::string answer_pictures(const ReportContent& content) {
    constexpr int kPictures = 3;
    std::string html;
    int shown_pictures = 0;
    for (const auto& [job, file] : kAnswerPictures) {
        for (const ShownFigure& shown : content.figures) {
            const bool wanted = shown.listed.job == job && shown.listed.file == file;
            if (!wanted || shown.picture.empty() || shown_pictures == kPictures) continue;
            html += fmt::format("<a href=\"#{}\"><img src=\"{}\" alt=\"{}: {}\"><span>{}: {}</span></a>\n",
                                shown.listed.id(), shown.picture, escape_html(shown.listed.figure),
                                escape_html(shown.listed.title), escape_html(shown.listed.figure),
                                escape_html(shown.listed.title));
            ++shown_pictures;
        }
    }
    return html.empty() ? "" : "<div class=\"pictures\">\n" + html + "</div>\n";
}

std::string answer_html(const ReportContent& content) {
    std::string html = "<section id=\"answer\">\n<h2>The answer</h2>\n<ul>\n";
    for (const Headline& line : headlines(content.scorecard)) {
        html += fmt::format("<li><strong>{}.</strong> {}</li>\n", escape_html(line.topic), escape_html(line.text));
    }
    return html + "</ul>\n" + answer_pictures(content) + "</section>\n";
}

std::string facts_html(const ReportContent& content) {
    std::string html = "<section id=\"facts\">\n<h2>This report</h2>\n<dl class=\"facts\">\n";
    html += fact("Sections", content.section == "all" ? "all (III to VII, coordination, energy)" : content.section);
    html += fact("Extent", content.reduced() ? "reduced (--quick)" : "full");
    html += fact("Version", content.version);
    html += fact("Program", content.program);
    html += fact("Machine", content.machine);
    html += fact("Seeds", content.seeds);
    html += fact("Command", content.command);
    return html + "</dl>\n</section>\n";
}

std::string contents(const ReportContent& content) {
    std::string html =
        "<nav aria-label=\"Contents\">\n<h2>Contents</h2>\n<ol>\n<li><a href=\"#facts\">This report</a></li>\n"
        "<li><a href=\"#rows-met\">Rows met</a></li>\n<li><a href=\"#scorecard\">Scorecard</a></li>\n";
    for (const ShownFigure& shown : content.figures) {
        if (shown.listed.job.empty()) continue;
        html += fmt::format("<li><a href=\"#{}\">{}: {}</a></li>\n", shown.listed.id(),
                            escape_html(shown.listed.figure), escape_html(shown.listed.title));
    }
    return html +
           "<li><a href=\"#not-drawn\">Figures that are not drawn</a></li>\n<li><a href=\"#tables\">Tables as CSV</a></li>\n"
           "<li><a href=\"#repeat\">How to repeat this report</a></li>\n</ol>\n</nav>\n";
}

HtmlTable::Cell verdict_cell(Verdict verdict) {
    if (verdict == Verdict::inside) return {"✓ inside", "inside"};
    if (verdict == Verdict::miss) return {"✗ outside", "miss"};
    if (verdict == Verdict::input) return {"input", "open"};
    if (verdict == Verdict::own) return {"own", "open"};
    return {"– open", "open"};
}

std::string score_table(const ReportContent& content, const std::string& section) {
    HtmlTable table(
        "Values of the paper and tolerances: data/paper/targets.csv. Own results: data/paper/own_rows.csv. Explanations: "
        "data/paper/explanations.csv.",
        {"Row", "Quantity", "Conditions", "Paper", "Ours", "Unit", "Difference", "Tolerance", "Verdict",
         "How it is measured; cause of a deviation"});
    for (const ScoredRow& row : content.scorecard.rows) {
        if (main_section(row.target.section) != section) continue;
        table.row({{row.target.id},
                   {quantity_text(row)},
                   {row.target.condition},
                   {row.target.value},
                   {row.ours},
                   {row.target.unit == "-" ? "" : row.target.unit},
                   {difference_text(row), "short"},
                   {tolerance_text(row.target)},
                   verdict_cell(row.verdict),
                   {explanation_text(row), "words"}},
                  "row-" + row.target.id);
    }
    return table.html();
}

std::string rows_met_html(const ReportContent& content) {
    HtmlTable summary(
        "Rows of the paper by section. Results: rows without the inputs. Open: the row states no tolerance, or these "
        "runs did not measure it.",
        {"Section", "Results", "Inside", "Outside", "Open", "Inputs"});
    const auto count_row = [&](const std::string& name, const std::string& section) {
        std::array<int, 5> counts{};
        for (const ScoredRow& row : content.scorecard.rows) {
            if (section.empty() || main_section(row.target.section) == section) {
                ++counts.at(static_cast<std::size_t>(row.verdict));
            }
        }
        summary.row({{name},
                     {fmt::format("{}", counts[0] + counts[1] + counts[2]), "number"},
                     {fmt::format("{}", counts[0]), "number"},
                     {fmt::format("{}", counts[1]), "number"},
                     {fmt::format("{}", counts[2]), "number"},
                     {fmt::format("{}", counts[3]), "number"}});
    };
    for (const std::string& section : paper_sections(content.scorecard.rows))
        count_row(section_title(section), section);
    count_row("All", "");
    return "<section id=\"rows-met\">\n<h2>Rows met</h2>\n" + summary.html() +
           fmt::format(
               "<p>Runs with overlaps, entries on red or lost vehicles: {:.0f}. All rows: <a href=\"#scorecard\">scorecard</a>, or <a "
               "href=\"tables/scorecard.csv\">scorecard.csv</a>.</p>\n</section>\n",
               content.scorecard.violations);
}

std::string scorecard_html(const ReportContent& content) {
    std::string html = "<section id=\"scorecard\">\n<h2>Scorecard</h2>\n";
    for (const std::string& section : main_sections(content.scorecard.rows)) {
        html += fmt::format("<h3>{}</h3>\n{}", escape_html(section_title(section)), score_table(content, section));
    }
    return html + "</section>\n";
}

std::string figure_html(const ReportContent& content, const ShownFigure& shown) {
    const ListedFigure& listed = shown.listed;
    std::string html = fmt::format("<figure id=\"{}\">\n", listed.id());
    if (!shown.problem.empty())
        html += fmt::format("<p class=\"problem\">Missing: {}</p>\n", escape_html(shown.problem));
    if (!shown.picture.empty()) {
        html += fmt::format("<img src=\"{}\" alt=\"{}: {}\">\n", shown.picture, escape_html(listed.figure),
                            escape_html(listed.title));
    }
    html += shown.table;
    html += fmt::format("<figcaption>\n<p><strong>{}</strong> (Section {}). <strong>{}.</strong>{} {}</p>\n",
                        escape_html(listed.figure), escape_html(listed.section), escape_html(listed.title),
                        content.reduced() ? " <span class=\"badge\">reduced</span>" : "", escape_html(listed.caption));
    if (!shown.picture.empty()) {
        html += fmt::format(
            "<p class=\"links\"><a href=\"figures/{0}.svg\">SVG</a>, <a href=\"figures/{0}.png\">PNG</a></p>\n",
            listed.id());
    }
    if (shown.problem.empty()) {
        html += "<details open><summary>Conditions and command</summary>\n<dl class=\"facts\">\n";
        for (const auto& [name, text] : shown.conditions) html += fact(name, text);
        html += fact("Seeds", shown.seeds) + fact("Version", content.version) + "</dl>\n";
        const std::vector<std::string> report_command{content.command};
        for (const std::string& command : shown.commands.empty() ? report_command : shown.commands) {
            html += fmt::format("<pre><code>{}</code></pre>\n", escape_html(command));
        }
        html += "</details>\n";
    }
    return html + "</figcaption>\n</figure>\n";
}

std::string figures_html(const ReportContent& content) {
    std::string html;
    std::string open_section;
    for (const ShownFigure& shown : content.figures) {
        if (shown.listed.job.empty()) continue;
        const std::string section = shown.listed.major_section();
        if (section != open_section) {
            if (!open_section.empty()) html += "</section>\n";
            html +=
                fmt::format("<section id=\"section-{}\">\n<h2>{}</h2>\n", section, escape_html(section_title(section)));
            open_section = section;
        }
        html += fmt::format("<h3>{}: {}</h3>\n", escape_html(shown.listed.figure), escape_html(shown.listed.title)) +
                figure_html(content, shown);
    }
    return open_section.empty() ? html : html + "</section>\n";
}

std::string not_drawn_html(const ReportContent& content) {
    std::string html = "<section id=\"not-drawn\">\n<h2>Figures that are not drawn</h2>\n";
    HtmlTable table("Figures and tables of the paper without a counterpart here",
                    {"Figure", "Section", "Content", "Reason"});
    bool found = false;
    for (const ShownFigure& shown : content.figures) {
        if (!shown.listed.job.empty()) continue;
        table.row({{shown.listed.figure}, {shown.listed.section}, {shown.listed.title}, {shown.listed.caption}});
        found = true;
    }
    return html + (found ? table.html() : "<p>None in these sections.</p>\n") + "</section>\n";
}

// Explains the columns of the summaries and sweeps of some kinds of networks.
std::string columns_html(const MetricGroup& group) {
    HtmlTable table("", {"Column", "Unit", "Extent", "Meaning"});
    std::set<std::string> known;
    for (const std::vector<ColumnDoc>* const columns : {&group.summary, &group.sweep}) {
        for (const ColumnDoc& column : *columns) {
            if (!known.insert(column.name).second) continue;
            table.row({{column.name}, {column.unit}, {column.extent}, {with_key(column.meaning, "`", ""), "words"}});
        }
    }
    return fmt::format("<details><summary>Columns of {}</summary>\n{}</details>\n", group.title, table.html());
}

std::string files_html(const ReportContent& content) {
    std::string html =
        "<section id=\"tables\">\n<h2>Tables as CSV</h2>\n<p>The name of each column ends with its unit.</p>\n<ul class=\"files\">\n";
    for (const std::string& name : content.tables) {
        html += fmt::format("<li><a href=\"tables/{0}\">{0}</a></li>\n", escape_html(name));
    }
    html += "</ul>\n<h3>Columns of the summaries and sweeps</h3>\n";
    for (const MetricGroup& group : metric_groups()) html += columns_html(group);
    return html + "</section>\n";
}

std::string repeat_html(const ReportContent& content) {
    std::string html = "<section id=\"repeat\">\n<h2>How to repeat this report</h2>\n";
    html += fmt::format("<pre><code>{}</code></pre>\n", escape_html(content.command));
    html += fmt::format(
        "<p>A second run reuses the finished jobs in its folder and writes the same bytes, with any number of threads. The mesoscale "
        "mode uses the parameters of data/meso/{}.yaml. <code>stopline-calibrate</code> repeats their fit.</p>\n",
        kCalibratedMeso);
    for (const std::string& problem : content.problems) {
        html += fmt::format("<p class=\"problem\">Failed: {}</p>\n", escape_html(problem));
    }
    if (!content.reduced()) return html + "</section>\n";
    HtmlTable table("Reductions of --quick (data/paper/quick.csv)", {"File", "Field", "Value here"});
    for (const Reductions::Row& row : content.reductions.rows()) {
        table.row({{"scenarios/" +
                    (row.applies_to.starts_with("scenarios/") ? row.applies_to.substr(10) : row.applies_to) + ".yaml"},
                   {row.field},
                   {row.value}});
    }
    return html + table.html() + "</section>\n";
}

}  // namespace

std::string report_page(const ReportContent& content) {
    return fmt::format(
               "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
               "content=\"width=device-width, initial-scale=1\">\n<title>Stopline: results{}</title>\n<style>{}</style>\n"
               "</head>\n<body>\n<div class=\"page\">\n",
               content.reduced() ? " (reduced)" : "", kPageStyle) +
           header(content) + answer_html(content) + contents(content) + "<main>\n" + facts_html(content) +
           rows_met_html(content) + scorecard_html(content) + figures_html(content) + not_drawn_html(content) +
           files_html(content) + repeat_html(content) +
           fmt::format("</main>\n<footer>Stopline {}. Made by <code>{}</code>.</footer>\n</div>\n</body>\n</html>\n",
                       escape_html(content.version), escape_html(content.command));
}

}  // namespace stopline

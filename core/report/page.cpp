// The page of the report: from what was found to HTML.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "report/html.h"
#include "report/page_style.h"
#include "report/report.h"
#include "scenario/load_scenario.h"

namespace stopline {

namespace {

constexpr const char* kPaper =
    "Massow, Radusch and Shorten, \"On Constant Distance Spacing Policies for Cooperative Adaptive Cruise Control\" (2021)";

std::string major(const std::string& section) { return section.substr(0, section.find_first_of(". ")); }

std::string section_title(const std::string& section) {
    constexpr std::array<std::pair<const char*, const char*>, 6> kTitles{
        {{"I", "numbers of the abstract and introduction"},
         {"III", "a single light"},
         {"IV", "a single intersection"},
         {"V", "two fidelities"},
         {"VI", "arterial and grid"},
         {"VII", "Berlin"}}};
    for (const auto& [name, title] : kTitles) {
        if (section == name) return fmt::format("Section {}: {}", section, title);
    }
    return "Section " + section;
}

// In their order, each once.
std::vector<std::string> sections_of(const std::vector<ScoredRow>& rows) {
    std::vector<std::string> sections;
    for (const ScoredRow& row : rows) {
        const std::string section = major(row.target.section);
        if (std::find(sections.begin(), sections.end(), section) == sections.end()) sections.push_back(section);
    }
    std::stable_partition(sections.begin(), sections.end(), [](const std::string& section) { return section == "I"; });
    return sections;
}

std::string fact(const std::string& what, const std::string& words) {
    return words.empty() ? "" : fmt::format("<dt>{}</dt><dd>{}</dd>\n", html_text(what), html_text(words));
}

std::string header(const ReportContent& content) {
    std::string html = "<header>\n<h1>Constant distance at traffic lights: the paper and what Stopline finds</h1>\n";
    html += fmt::format(
        "<p>A reproduction of {}, from our own model. Nothing on this page was typed by hand: all numbers come from "
        "the runs, the scenarios and the table of the paper's numbers.</p>\n",
        html_text(kPaper));
    if (content.reduced()) {
        html +=
            "<div class=\"reduced\"><strong>REDUCED: a first look.</strong> Fewer combinations, shorter runs or fewer seeds than the "
            "whole; which ones is listed <a href=\"#made\">below</a>. Rows and figures are what these runs give, not what the whole "
            "gives: leave out <code>--quick</code> for that. The explanations beside rows are those of the whole.</div>\n";
    }
    html += "<dl class=\"facts\">\n";
    html += fact("Sections", content.section == "all" ? "all (III to VII)" : content.section);
    html += fact("Extent", content.reduced() ? "reduced (--quick)" : "full");
    html += fact("Version", content.version);
    html += fact("Program", content.program);
    html += fact("Machine", content.machine);
    html += fact("Seeds", content.seeds);
    html += fact("Command", content.command);
    return html + "</dl>\n";
}

std::string contents(const ReportContent& content) {
    std::string html =
        "<nav aria-label=\"Contents\">\n<h2>Contents</h2>\n<ol>\n<li><a href=\"#scorecard\">Scorecard</a></li>\n";
    for (const ShownFigure& shown : content.figures) {
        if (shown.listed.job.empty()) continue;
        html += fmt::format("<li><a href=\"#{}\">{}: {}</a></li>\n", shown.listed.id(), html_text(shown.listed.figure),
                            html_text(shown.listed.title));
    }
    return html +
           "<li><a href=\"#not-drawn\">Figures that are not drawn</a></li>\n<li><a href=\"#tables\">Tables as CSV</a></li>\n"
           "<li><a href=\"#made\">How this was made</a></li>\n</ol>\n</nav>\n</header>\n";
}

HtmlTable::Cell verdict_cell(Verdict verdict) {
    if (verdict == Verdict::inside) return {"✓ inside", "inside"};
    if (verdict == Verdict::miss) return {"✗ outside", "miss"};
    return {"– open", "open"};
}

std::string difference_text(const ScoredRow& row) {
    const std::optional<double> paper = parse_number(row.target.value);
    const std::optional<double> ours = parse_number(row.ours);
    if (!paper || !ours) return "";
    const double difference = *ours - *paper;
    if (std::abs(difference) < 1e-9) return "0";
    std::string text = fmt::format("{:+.4g}", difference);
    if (row.target.unit != "%" && *paper != 0.0) text += fmt::format(" ({:+.1f} %)", 100.0 * difference / *paper);
    return text;
}

std::string score_table(const ReportContent& content, const std::string& section) {
    HtmlTable table("Paper and tolerance: data/paper/targets.csv; explanations: data/paper/explanations.csv",
                    {"Row", "Quantity", "Conditions", "Paper", "Ours", "Unit", "Difference", "Tolerance", "Verdict",
                     "How it is counted; why it is outside"});
    for (const ScoredRow& row : content.scorecard.rows) {
        if (major(row.target.section) != section) continue;
        const std::string between = row.counted.empty() || row.reason.empty() ? "" : "; ";
        std::string quantity = row.target.quantity;
        std::replace(quantity.begin(), quantity.end(), '_', ' ');
        table.row({{row.target.id},
                   {quantity},
                   {row.target.condition},
                   {row.target.value},
                   {row.ours},
                   {row.target.unit == "-" ? "" : row.target.unit},
                   {difference_text(row), "short"},
                   {tolerance_text(row.target)},
                   verdict_cell(row.verdict),
                   {row.counted + between + row.reason, "words"}},
                  "row-" + row.target.id);
    }
    return table.html();
}

std::string summary_html(const ReportContent& content) {
    HtmlTable summary("Rows of the paper by section. Open: the row states no tolerance, or was not measured here.",
                      {"Section", "Rows", "Inside", "Outside", "Open"});
    const auto count_row = [&](const std::string& name, const std::string& section) {
        std::array<int, 3> counts{};
        for (const ScoredRow& row : content.scorecard.rows) {
            if (section.empty() || major(row.target.section) == section) {
                ++counts.at(static_cast<std::size_t>(row.verdict));
            }
        }
        summary.row({{name},
                     {fmt::format("{}", counts[0] + counts[1] + counts[2]), "number"},
                     {fmt::format("{}", counts[0]), "number"},
                     {fmt::format("{}", counts[1]), "number"},
                     {fmt::format("{}", counts[2]), "number"}});
    };
    for (const std::string& section : sections_of(content.scorecard.rows)) count_row(section_title(section), section);
    count_row("Together", "");
    return "<h2>How well the paper is met</h2>\n" + summary.html() +
           fmt::format(
               "<p>Runs in which vehicles overlapped, entered on red or were lost: {:.0f}. All rows: <a "
               "href=\"#scorecard\">scorecard</a>; as CSV: <a href=\"tables/scorecard.csv\">scorecard.csv</a>.</p>\n",
               content.scorecard.violations);
}

std::string scorecard_html(const ReportContent& content) {
    std::string html = "<section id=\"scorecard\">\n<h2>Scorecard</h2>\n";
    for (const std::string& section : sections_of(content.scorecard.rows)) {
        html += fmt::format("<h3>{}</h3>\n{}", html_text(section_title(section)), score_table(content, section));
    }
    return html + "</section>\n";
}

std::string figure_html(const ReportContent& content, const ShownFigure& shown) {
    const ListedFigure& listed = shown.listed;
    std::string html = fmt::format("<figure id=\"{}\">\n", listed.id());
    if (!shown.problem.empty())
        html += fmt::format("<p class=\"problem\">Not here: {}</p>\n", html_text(shown.problem));
    if (!shown.picture.empty()) {
        html += fmt::format("<img src=\"{}\" alt=\"{}: {}\">\n", shown.picture, html_text(listed.figure),
                            html_text(listed.title));
    }
    html += shown.table;
    html += fmt::format("<figcaption>\n<p><strong>{}</strong> (Section {}). <strong>{}.</strong>{} {}</p>\n",
                        html_text(listed.figure), html_text(listed.section), html_text(listed.title),
                        content.reduced() ? " <span class=\"badge\">reduced</span>" : "", html_text(listed.caption));
    if (!shown.picture.empty()) {
        html += fmt::format(
            "<p class=\"links\"><a href=\"figures/{0}.svg\">SVG</a>, <a href=\"figures/{0}.png\">PNG</a></p>\n",
            listed.id());
    }
    if (shown.problem.empty()) {
        html += "<details open><summary>Conditions and command</summary>\n<dl class=\"facts\">\n";
        for (const auto& [what, words] : shown.conditions) html += fact(what, words);
        html += fact("Seeds", shown.seeds) + fact("Version", content.version) + "</dl>\n";
        const std::vector<std::string> own{content.command};
        for (const std::string& command : shown.commands.empty() ? own : shown.commands) {
            html += fmt::format("<pre><code>{}</code></pre>\n", html_text(command));
        }
        html += "</details>\n";
    }
    return html + "</figcaption>\n</figure>\n";
}

std::string figures_html(const ReportContent& content) {
    std::string html;
    std::string open;
    for (const ShownFigure& shown : content.figures) {
        if (shown.listed.job.empty()) continue;
        const std::string section = shown.listed.major_section();
        if (section != open) {
            if (!open.empty()) html += "</section>\n";
            html +=
                fmt::format("<section id=\"section-{}\">\n<h2>{}</h2>\n", section, html_text(section_title(section)));
            open = section;
        }
        html += fmt::format("<h3>{}: {}</h3>\n", html_text(shown.listed.figure), html_text(shown.listed.title)) +
                figure_html(content, shown);
    }
    return open.empty() ? html : html + "</section>\n";
}

std::string not_drawn_html(const ReportContent& content) {
    std::string html = "<section id=\"not-drawn\">\n<h2>Figures that are not drawn</h2>\n";
    HtmlTable table("Figures and tables of the paper that have no numbers to reproduce, or that we cannot make",
                    {"Figure", "Section", "What it shows", "Why"});
    bool any = false;
    for (const ShownFigure& shown : content.figures) {
        if (!shown.listed.job.empty()) continue;
        table.row({{shown.listed.figure}, {shown.listed.section}, {shown.listed.title}, {shown.listed.caption}});
        any = true;
    }
    return html + (any ? table.html() : "<p>None in these sections.</p>\n") + "</section>\n";
}

std::string files_html(const ReportContent& content) {
    std::string html =
        "<section id=\"tables\">\n<h2>Tables as CSV</h2>\n<p>The unit is the end of each column's name.</p>\n<ul class=\"files\">\n";
    for (const std::string& name : content.tables) {
        html += fmt::format("<li><a href=\"tables/{0}\">{0}</a></li>\n", html_text(name));
    }
    return html + "</ul>\n</section>\n";
}

std::string made_html(const ReportContent& content) {
    std::string html = "<section id=\"made\">\n<h2>How this was made</h2>\n";
    html += fmt::format("<pre><code>{}</code></pre>\n", html_text(content.command));
    html += fmt::format(
        "<p>Run again it takes what is finished from its folder and writes the same bytes; the number of threads does not matter. The "
        "parameters of the mesoscale mode are those in data/meso/{}.yaml; the fit itself is repeated by "
        "<code>stopline-calibrate</code>.</p>\n",
        kCalibratedMeso);
    for (const std::string& problem : content.problems) {
        html += fmt::format("<p class=\"problem\">Failed: {}</p>\n", html_text(problem));
    }
    if (!content.reduced()) return html + "</section>\n";
    HtmlTable table("What --quick leaves out (data/paper/quick.csv): instead of what the file says",
                    {"File", "Field", "Here"});
    for (const Reductions::Row& row : content.reductions.rows()) {
        table.row({{"scenarios/" + (row.what.starts_with("scenarios/") ? row.what.substr(10) : row.what) + ".yaml"},
                   {row.field},
                   {row.value}});
    }
    return html + table.html() + "</section>\n";
}

}  // namespace

std::string report_page(const ReportContent& content) {
    return fmt::format(
               "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
               "content=\"width=device-width, initial-scale=1\">\n<title>Stopline: the paper reproduced{}</title>\n<style>{}</style>\n"
               "</head>\n<body>\n<div class=\"page\">\n",
               content.reduced() ? " (reduced)" : "", kPageStyle) +
           header(content) + summary_html(content) + contents(content) + "<main>\n" + scorecard_html(content) +
           figures_html(content) + not_drawn_html(content) + files_html(content) + made_html(content) +
           fmt::format("</main>\n<footer>Stopline {}. Made by <code>{}</code>.</footer>\n</div>\n</body>\n</html>\n",
                       html_text(content.version), html_text(content.command));
}

}  // namespace stopline

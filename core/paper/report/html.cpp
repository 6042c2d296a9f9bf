#include "paper/report/html.h"

#include <cctype>
#include <utility>

#include <fmt/format.h>

#include "base/io/csv.h"
#include "base/io/escape.h"
#include "reference/targets.h"

namespace stopline {

std::string html_id(std::string_view text) {
    std::string id;
    for (const char c : text) {
        const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
        id += plain ? c : '-';
    }
    return id;
}

HtmlTable::HtmlTable(std::string caption, std::vector<std::string> columns)
    : caption_(std::move(caption)), columns_(std::move(columns)), numbers_(columns_.size(), false) {}

void HtmlTable::row(const std::vector<Cell>& cells, const std::string& id) {
    for (std::size_t k = 0; k < cells.size() && k < numbers_.size() && rows_.empty(); ++k) {
        numbers_[k] = cells[k].css == "number";
    }
    rows_ += id.empty() ? "<tr>" : fmt::format("<tr id=\"{}\">", html_id(id));
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const std::string css = cells[k].css.empty() ? "" : fmt::format(" class=\"{}\"", escape_html(cells[k].css));
        const std::string label = k < columns_.size() ? escape_html(columns_[k]) : "";
        rows_ += k == 0 ? fmt::format("<th scope=\"row\"{}>{}</th>", css, escape_html(cells[k].text))
                        : fmt::format("<td{} data-label=\"{}\">{}</td>", css, label, escape_html(cells[k].text));
    }
    rows_ += "</tr>\n";
}

std::string HtmlTable::html() const {
    std::string head;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        head += fmt::format("<th scope=\"col\"{}>{}</th>", numbers_[k] ? " class=\"number\"" : "",
                            escape_html(columns_[k]));
    }
    const std::string caption = caption_.empty() ? "" : fmt::format("<caption>{}</caption>\n", escape_html(caption_));
    return fmt::format("<table>\n{}<thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody>\n</table>\n", caption, head, rows_);
}

std::string html_of_csv(const std::string& csv, const std::string& label) {
    const CsvTable table = parse_csv(csv, label);
    HtmlTable html("", table.columns);
    for (const std::vector<std::string>& row : table.rows) {
        std::vector<HtmlTable::Cell> cells;
        for (const std::string& text : row) cells.push_back({text, parse_number(text) ? "number" : ""});
        html.row(cells);
    }
    return html.html();
}

}  // namespace stopline

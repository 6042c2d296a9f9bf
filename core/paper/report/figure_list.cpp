#include "paper/report/figure_list.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/csv.h"
#include "base/io/output.h"
#include "paper/report/html.h"
#include "paper/report/job.h"

namespace stopline {

std::string ListedFigure::id() const {
    const std::string number_text = figure.substr(0, figure.find(','));  // "Fig. 5, speeds" gives "Fig. 5"
    std::string kind;
    std::string number;
    for (const char c : number_text) {
        if (std::isdigit(static_cast<unsigned char>(c)) != 0)
            number += c;
        else if (std::isalpha(static_cast<unsigned char>(c)) != 0)
            kind += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    const std::string name = is_table() ? file.substr(0, file.size() - 4) : file;
    return html_id(fmt::format("{}{:0>2}_{}", kind, number, name));
}

std::vector<ListedFigure> load_figure_list(const std::filesystem::path& file) {
    const CsvTable table = parse_csv(read_file(file), file.string());
    const std::size_t figure = table.column("figure"), section = table.column("section"), job = table.column("job");
    const std::size_t name = table.column("file"), title = table.column("title"), caption = table.column("caption");
    std::vector<ListedFigure> figures;
    for (std::size_t k = 0; k < table.rows.size(); ++k) {
        const std::vector<std::string>& row = table.rows[k];
        const auto& jobs = all_jobs();
        const bool known = row[job].empty() || row[job] == kComparisonJob ||
                           std::any_of(jobs.begin(), jobs.end(), [&](const Job& j) { return row[job] == j.name; });
        if (!known) throw InputError(fmt::format("{}:{}: unknown job '{}'", table.label, table.lines[k], row[job]));
        figures.push_back({row[figure], row[section], row[job], row[name], row[title], row[caption]});
    }
    return figures;
}

}  // namespace stopline

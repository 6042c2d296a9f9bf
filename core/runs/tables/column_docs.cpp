#include "runs/tables/column_docs.h"

#include <stdexcept>

#include <fmt/format.h>

#include "runs/tables/column_aliases.h"
#include "scenario/kinds/network_kind.h"

namespace stopline {

namespace {

constexpr const char* kIntroduction =
    R"(# Columns of the result tables

`stopline-run --describe-columns` prints this page. Its text is in `core/runs`.

Each section describes the columns of one CSV file. The first part of its title is the kind of network or the program.

The column *extent* says which part of a run a value covers:

| extent | meaning |
|---|---|
| window | the measured time window and the measured area |
| run | the whole run from 0 s, in the whole network |
| interval | one interval of `measure.interval` |
| green | the green that begins at `signal.first_green` |
| stretch | one of two periods of the run: minutes 15 to 60, or 65 to 120 |
| ..., area | only the measured area |
| ..., network | the whole network |
| seeds | all runs of a sweep that differ only in their seed |

The measured time window of a network is `window_from_s` to `window_to_s` in its `summary.csv`. The measured area of
grids and streets ends `measure.area_margin` beyond the outer stop lines. An imported network is measured as a whole.

- An empty cell means that there is no such value.
- Times count from the start of the run, unless the meaning says otherwise.
- A vehicle is stopped if its speed is below 0.1 m/s.
- Vehicles have numbers, and lanes have names. Both are the same in all files of a run.
- Vehicles that have not entered the network yet are counted only in the column `backlog`.
- CAPITALS in a name stand for a part that varies.

)";

}  // namespace

const std::vector<TableDoc>& table_docs() {
    static const std::vector<TableDoc> kTables = [] {
        std::vector<TableDoc> all;
        for (const auto group :
             {network_table_docs, intersection_table_docs, single_light_table_docs, driving_table_docs, hcm_table_docs,
              sweep_table_docs, string_table_docs, program_table_docs}) {
            for (TableDoc& table : group()) all.push_back(std::move(table));
        }
        return all;
    }();
    return kTables;
}

std::string table_group(const NetworkSettings& network) { return std::string(network_kind(network).run); }

std::vector<ColumnDoc> with_population(const std::vector<ColumnDoc>& columns) {
    std::vector<ColumnDoc> all{kPopulationColumn};
    all.insert(all.end(), columns.begin(), columns.end());
    return all;
}

ColumnDoc column_doc(const std::vector<TableDoc>& tables, std::string_view table, std::string_view column) {
    for (const TableDoc& doc : tables) {
        if (doc.name != table) continue;
        for (const ColumnDoc& found : doc.columns) {
            if (found.name == column) return found;
        }
    }
    throw std::logic_error(fmt::format("{} has no description of the column {}", table, column));
}

std::string table_markdown(const TableDoc& table) {
    std::string text = fmt::format("## {}\n\n{}\n\n", table.name, table.rows);
    text += "| column | unit | extent | meaning |\n|---|---|---|---|\n";
    for (const ColumnDoc& column : table.columns) {
        text += fmt::format("| `{}` | {} | {} | {} |\n", column.name, column.unit, column.extent, column.meaning);
    }
    return text + "\n";
}

std::string columns_markdown() {
    std::string text = kIntroduction;
    for (const TableDoc& table : table_docs()) text += table_markdown(table);
    return text + old_names_markdown();
}

}  // namespace stopline

// Descriptions of the columns in the tables of sweeps.
#include <algorithm>
#include <utility>

#include "runs/metrics/metric_groups.h"
#include "runs/tables/column_docs.h"
#include "scenario/kinds/network_kind.h"

namespace stopline {

namespace {

// Returns the columns of sweeps of all kinds of networks, each name once. The meaning of a column that networks of
// several intersections do not have begins with the kinds that have it.
std::vector<ColumnDoc> run_columns() {
    std::vector<ColumnDoc> columns{
        {"point", "", "", "number of the run, from 0"},
        {"population", "", "", "name of the population. Each other axis of the sweep has a column too, with its unit"},
        {"seed", "", "", "seed of the run"},
    };
    for (const MetricGroup& group : metric_groups()) {
        const std::string mark = group.name == kRunAsNetwork ? "" : std::string(group.title) + ": ";
        for (ColumnDoc column : group.sweep) {
            const bool is_known = std::any_of(columns.begin(), columns.end(),
                                              [&](const ColumnDoc& known) { return known.name == column.name; });
            if (is_known) continue;
            column.meaning.insert(0, mark);
            columns.push_back(std::move(column));
        }
    }
    return columns;
}

}  // namespace

std::vector<TableDoc> sweep_table_docs() {
    return {
        {"sweep/NAME.csv",
         "One row for each run. Each kind of network has some of these columns. Columns of single intersections or single "
         "lights\nalone are marked.\n"
         "The area of a single intersection is the intersection itself.",
         run_columns()},
        {"sweep/NAME_means.csv",
         "Written if a sweep has several seeds. The first columns are the axes.\n"
         "One row for each combination of axis values and each numeric column of `NAME.csv`.",
         {{"metric", "", "", "name of the column in `NAME.csv`"},
          {"runs", "", "seeds", "number of seeds with a value"},
          {"mean", "of the metric", "seeds", "mean; empty for fewer than two seeds"},
          {"ci95_low", "of the metric", "seeds", "lower bound of the 95 % confidence interval of the mean (Student)"},
          {"ci95_high", "of the metric", "seeds", "upper bound of this interval"},
          {"difference", "of the metric", "seeds",
           "mean difference from the run of the baseline with the same seed; empty for the baseline. The baseline is "
           "`measure.baseline`, or else the first population of the sweep"},
          {"difference_ci95_low", "of the metric", "seeds",
           "lower bound of the 95 % confidence interval of the difference. If the interval excludes 0, the "
           "difference is significant"},
          {"difference_ci95_high", "of the metric", "seeds", "upper bound of this interval"}}},
        {"sweep/table1.csv",
         "Written for sweeps of `scenarios/intersection.yaml` over greens and turn shares.\n"
         "One row for each value in Table 1 of the paper.",
         {{"id", "", "", "row of `data/paper/targets.csv`"},
          kPopulationColumn,
          {"green_s", "s", "", "green time"},
          {"left_percent", "%", "", "share of left turns"},
          {"right_percent", "%", "", "share of right turns"},
          {"paper_percent", "%", "", "improvement over CTG-Ref in the paper"},
          {"ours_percent", "%", "seeds", "improvement over CTG-Ref in the sweep; empty: not in the sweep"},
          {"difference_percent", "%", "seeds", "`ours_percent` minus `paper_percent`, in percentage points"}}},
    };
}

}  // namespace stopline

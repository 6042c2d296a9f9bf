#include "sweep/sweep_text.h"

#include <vector>

#include <fmt/format.h>

#include "base/io/csv.h"
#include "common/text_table.h"

namespace stopline {

std::string points_csv(const Sweep& sweep, const Shard& shard) {
    std::vector<std::string> columns = sweep.columns();
    columns.insert(columns.begin(), "point");
    columns.emplace_back("seed");
    CsvWriter csv(columns);
    for (std::size_t point = 0; point < sweep.points(); ++point) {
        if (!shard.has(point)) continue;
        std::vector<std::string> cells = sweep.cells(point);
        cells.insert(cells.begin(), fmt::format("{}", point));
        cells.push_back(fmt::format("{}", sweep.seed(point)));
        csv.row(cells);
    }
    return csv.text();
}

std::string totals_text(const SweepTotals& totals) {
    TextTable table("lr");
    table.add_row({"runs", fmt::format("{}", totals.runs)});
    table.add_row({"vehicle updates", fmt::format("{}", totals.updates)});
    table.add_row({"overlaps", fmt::format("{}", totals.overlaps)});
    table.add_row({"entries on red", fmt::format("{}", totals.red_entries)});
    table.add_row({"lost vehicles", fmt::format("{}", totals.lost_vehicles)});
    if (totals.deadlocks) table.add_row({"deadlocks", fmt::format("{}", *totals.deadlocks)});
    table.add_row({"runs with any of these violations", fmt::format("{}", totals.runs_with_violations)});
    if (totals.gridlocks) {
        table.add_row({"gridlocks", fmt::format("{}", *totals.gridlocks)});
        table.add_row({"teleported vehicles", fmt::format("{}", totals.teleported)});
    }
    if (totals.gridlocks || totals.deadlocks) {
        table.add_row({"runs with starving movements", fmt::format("{}", totals.starving_runs)});
    }
    if (totals.longest_in_junction_s > 0.0) {
        table.add_row({"longest time in a junction", fmt::format("{:.1f} s", totals.longest_in_junction_s)});
    }
    std::string text = table.text();
    if (totals.measured_in_warm_up > 0) {
        text += fmt::format(
            "In {} of {} runs the measured window begins before the end of the warm-up (window_from_s, warm_up_s).\n",
            totals.measured_in_warm_up, totals.runs);
    }
    if (totals.with_backlog > 0) {
        text += fmt::format(
            "In {} of {} runs a backlog of vehicles that found no room to enter is left (column backlog).\n",
            totals.with_backlog, totals.runs);
    }
    return text;
}

}  // namespace stopline

// Descriptions of the columns in the tables of a single intersection and of a single light.
#include "runs/metrics/metric_groups.h"
#include "runs/metrics/metric_tables.h"
#include "runs/single_light/single_light_metrics.h"
#include "runs/tables/column_docs.h"
#include "scenario/kinds/network_kind.h"

namespace stopline {

namespace {

const ColumnDoc kVehicle{"vehicle", "", "", "number of the vehicle"};
const ColumnDoc kPolicy{"policy", "", "", "spacing policy of the vehicle"};

std::vector<ColumnDoc> motion_columns() {
    return {{"speed_mps", "m/s", "", "speed"},
            {"acceleration_mps2", "m/s2", "", "acceleration"},
            {"request_mps2", "m/s2", "", "acceleration that the controller requests"},
            {"net_gap_m", "m", "", "gap to the rear of the leader; empty: no leader"},
            {"gear", "", "", "engaged gear, from 1; 0 in the mesoscale mode"}};
}

std::vector<ColumnDoc> green_columns() {
    std::vector<ColumnDoc> columns = metric_docs(summary_columns(green_metrics(), nullptr));
    for (ColumnDoc& column : columns) column.meaning = with_key(column.meaning, kThisGreen, "this time");
    return columns;
}

std::vector<ColumnDoc> joined(std::vector<ColumnDoc> first, const std::vector<ColumnDoc>& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

}  // namespace

// Returns the columns of v2v_modes.csv, which all kinds of networks share.
static std::vector<ColumnDoc> v2v_columns() {
    const std::vector<TableDoc> network = network_table_docs();
    std::vector<ColumnDoc> columns{kPopulationColumn};
    for (const char* name : {"time_s", "vehicle", "leader", "from", "to", "message_age_s", "net_gap_m", "speed_mps"}) {
        columns.push_back(column_doc(network, "network/v2v_modes.csv", name));
    }
    return columns;
}

std::vector<TableDoc> intersection_table_docs() {
    const std::vector<TableDoc> network = network_table_docs();
    const auto as_starving = [&](std::string_view column) {
        return column_doc(network, "network/starvations.csv", column);
    };
    return {
        {"intersection/summary.csv",
         "One row for each population. The window is `measure.cycles` whole cycles after `measure.warmup_cycles`.",
         with_population(metric_group(kRunAsIntersection).summary)},
        {"intersection/headways.csv",
         "One row for each population, lane and queue position. "
         "Only vehicles that were queued before the stop line count.",
         {kPopulationColumn,
          {"lane", "", "", "approach lane"},
          {"position", "", "", "position in the queue, from 1"},
          {"headway_s", "s", "window", "mean headway over greens; first position: time since the start of green"},
          {"samples", "", "window", "number of headways in the mean"}}},
        {"intersection/starvations.csv",
         "One row for each starving vehicle, as in `network/starvations.csv`.",
         {kPopulationColumn, as_starving("lane"), as_starving("vehicle"), as_starving("cause"), as_starving("from_s"),
          as_starving("to_s")}},
        {"intersection/v2v_modes.csv", "One row for each change of a driving mode, as in `network/v2v_modes.csv`.",
         v2v_columns()},
        {"intersection/trajectories.csv",
         "Written with `--trajectories`, for the first measured cycle. One row for each vehicle and each `--interval`.",
         joined({kPopulationColumn,
                 {"time_s", "s", "run", "time of the sample"},
                 kVehicle,
                 kPolicy,
                 {"lane", "", "", "lane of the vehicle"},
                 {"position_m", "m", "", "distance of its front from the start of its route"},
                 {"x_m", "m", "", "position of its front toward the east"},
                 {"y_m", "m", "", "position of its front toward the north"}},
                motion_columns())},
    };
}

std::vector<TableDoc> single_light_table_docs() {
    return {
        {"single_light/summary.csv", "One row for each population.",
         with_population(metric_group(kRunAsSingleLight).summary)},
        {"single_light/improvement.csv", "One row for each population and each green time of `measure.green`.",
         with_population(green_columns())},
        {"single_light/passages.csv",
         "One row for each vehicle that passes the stop line in the green.",
         {kPopulationColumn,
          {"lane", "", "", "lane, from 0"},
          {"position", "", "", "position in the queue of the lane, from 1"},
          kVehicle,
          kPolicy,
          {"time_s", "s", "green", "time from the start of green until its front passes the stop line"},
          {"headway_s", "s", "green", "time since the previous vehicle on the same lane; empty for the first"},
          {"speed_mps", "m/s", "green", "speed at the stop line"}}},
        {"single_light/v2v_modes.csv",
         "One row for each change of a driving mode, as in `network/v2v_modes.csv`. Times count from the start of the run.",
         v2v_columns()},
        {"single_light/trajectories.csv",
         "Written with `--trajectories`, from 5 s before the green to 25 s after its end.\n"
         "One row for each vehicle and each `--interval`.",
         joined({kPopulationColumn,
                 {"time_s", "s", "", "time of the sample, from the start of green"},
                 kVehicle,
                 kPolicy,
                 {"lane", "", "", "lane, from 0"},
                 {"position_m", "m", "", "distance of its front from the stop line; negative upstream of it"}},
                motion_columns())},
    };
}

}  // namespace stopline

// Descriptions of the columns in the tables of sweeps.
#include "runs/tables/column_docs.h"

namespace stopline {

namespace {

constexpr std::string_view kNetwork = "network/summary.csv";
constexpr std::string_view kIntersection = "intersection/summary.csv";
constexpr std::string_view kSingleLight = "single_light/summary.csv";

std::vector<ColumnDoc> run_columns() {
    const std::vector<TableDoc> network = network_table_docs();
    const std::vector<TableDoc> intersection = intersection_table_docs();
    const std::vector<TableDoc> single_light = single_light_table_docs();
    std::vector<ColumnDoc> columns{
        {"point", "", "", "number of the run, from 0"},
        {"population", "", "", "name of the population. Each other axis of the sweep has a column too, with its unit"},
        {"seed", "", "", "seed of the run"},
    };
    const auto copy = [&](const std::vector<TableDoc>& tables, std::string_view table,
                          std::initializer_list<std::string_view> names) {
        for (const std::string_view name : names) columns.push_back(column_doc(tables, table, name));
    };
    const auto add = [&](std::initializer_list<ColumnDoc> docs) { columns.insert(columns.end(), docs); };

    // Columns of networks of several intersections.
    copy(network, kNetwork, {"throughput_veh_h", "travel_time_s", "density_percent"});
    add({{"throughput_SIDE_SIDE_veh_h", "veh/h", "window",
          "grids and streets: throughput straight through the network, from the first side to the second"},
         {"travel_time_SIDE_SIDE_s", "s", "window", "mean travel time of these vehicles"}});
    copy(network, kNetwork, {"vehicles_in_area", "vehicles_present", "max_present", "window_from_s", "window_to_s"});
    copy(network, kNetwork, {"warm_up_s", "stability", "unstable_by", "collapse_s", "gridlocks"});
    copy(network, kNetwork,
         {"first_gridlock_s", "starvations", "teleported", "passed_blockers", "delay_signal_h", "delay_yielding_h"});
    copy(network, kNetwork,
         {"delay_junction_blocking_h", "delay_turn_blocking_h", "delay_spillback_h", "delay_gridlock_h",
          "delay_wrong_lane_h"});
    copy(network, kNetwork, {"delay_queue_discharge_h", "delay_upstream_h", "backlog"});
    // Columns of streets.
    add({{"throughput_STRETCH_veh_h", "veh/h", "stretch, area",
          "streets: vehicles that leave the area in minutes 15 to 60 (`early`) and 65 to 120 (`late`); empty if the "
          "run is shorter"},
         {"travel_time_STRETCH_s", "s", "stretch, area", "mean time of these vehicles in the area"},
         {"density_STRETCH_percent", "%", "stretch, area", "share of the lane length in the area that vehicles occupy"},
         {"inflow_west_STRETCH_veh_h", "veh/h", "stretch, area", "vehicles that enter the area from the west"},
         {"inflow_east_STRETCH_veh_h", "veh/h", "stretch, area", "vehicles that enter the area from the east"},
         {"inflow_minor_STRETCH_veh_h", "veh/h", "stretch, area",
          "vehicles that enter the area from the south and the north"},
         {"congested_from_APPROACH_s", "s", "run", "streets: as `congested_from_s` in `network/turns.csv`"},
         {"mandatory_lane_changes", "", "run", "streets: lane changes because the route continues in another lane"},
         {"discretionary_lane_changes", "", "run", "streets: lane changes for a higher speed"}});
    copy(network, kNetwork, {"longest_stop_s", "longest_in_junction_s"});

    // Columns of single intersections.
    copy(intersection, kIntersection,
         {"travel_time_RADIUSm_s", "delay_RADIUSm_s", "density_RADIUSm_percent", "density_network_percent",
          "vehicles_per_green"});
    copy(intersection, kIntersection, {"saturated_greens"});
    add({{"saturation_headway_s", "s", "window",
          "single intersections: mean headway from the fifth vehicle of a queue on; empty: no saturated green"}});
    copy(intersection, kIntersection,
         {"startup_lost_time_s", "queue_veh", "longest_queue_m", "turned_right_percent", "turned_left_percent"});
    add({{"gaps_accepted", "", "run", "single intersections: gaps that left-turning vehicles accepted"}});

    // Columns of single lights.
    add({{"passed_K_veh", "veh", "green",
          "single lights: vehicles that pass the stop line within the K-th green time of `measure.green`"}});
    copy(single_light, kSingleLight,
         {"queue_emptied_s", "steady_vehicles", "not_closed_up_vehicles", "steady_headway_s", "steady_net_gap_m"});

    // Columns of all kinds of networks.
    add({{"vehicles_entered", "veh", "run", "vehicles that entered the network"},
         {"vehicles_exited", "veh", "run", "vehicles that left the network"},
         {"overlaps", "", "run", "sum of `overlaps` and `conflicts` of `network/summary.csv`; a violation"}});
    copy(network, kNetwork, {"red_entries", "forced_red_entries", "lost_vehicles"});
    copy(intersection, kIntersection, {"deadlocks"});
    add({{"updates", "", "run", "vehicles times steps"}});
    copy(single_light, kSingleLight, {"state_hash"});
    return columns;
}

}  // namespace

std::vector<TableDoc> sweep_table_docs() {
    return {
        {"sweep/NAME.csv",
         "One row for each run. Each kind of network has some of these columns.\n"
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

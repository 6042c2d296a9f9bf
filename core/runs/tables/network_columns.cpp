// Descriptions of the columns in the tables of grids, streets and imported networks.
#include <utility>

#include "runs/tables/column_docs.h"

namespace stopline {

namespace {

std::vector<ColumnDoc> window_columns() {
    return {
        kPopulationColumn,
        {"throughput_veh_h", "veh/h", "window", "vehicles that leave the area; imported networks: trips that end"},
        {"improvement_percent", "%", "window", "gain in throughput over `measure.baseline`; empty without a baseline"},
        {"travel_time_s", "s", "window",
         "mean time in the area, over the vehicles that leave it within the window; queues upstream of the area do not "
         "count. Imported networks: mean time from entering the network to the end of the trip"},
        {"travel_time_saved_percent", "%", "window",
         "reduction of the travel time, compared with `measure.baseline`. Empty without a baseline. Also empty if in "
         "either run the number of vehicles in the area, divided by the throughput, exceeds `travel_time_s` by more "
         "than 50 %: then the travel times cover only the few vehicles that get through"},
        {"density_percent", "%", "window",
         "share of the lane length in the area that vehicles occupy; the length across an intersection counts once for "
         "each lane that leads to it"},
        {"vehicles_in_area", "veh", "window", "mean number of vehicles in the area"},
        {"vehicles_present", "veh", "window, network", "mean number of vehicles in the network, sampled every second"},
        {"max_present", "veh", "run", "largest number of vehicles in the network, sampled every second"},
        {"window_from_s", "s", "",
         "start of the measured window. The window consists of the whole intervals (`measure.interval`) in the last "
         "`measure.window` of the run. A run that is not longer than `measure.window` is measured from `warm_up_s` on. "
         "Empty: the window contains no whole interval"},
        {"window_to_s", "s", "", "end of the measured window"},
        {"warm_up_s", "s", "run",
         "end of the warm-up, found from the number of vehicles in the area with the rule MSER-5"},
    };
}

std::vector<ColumnDoc> stability_columns() {
    return {
        {"stability", "", "run",
         "`stable`: no gridlock and no teleported vehicle. `semi-stable`: all gridlocks dissolve, and less than 1 % "
         "of the exited vehicles were teleported. `unstable`: for the reason in `unstable_by`"},
        {"unstable_by", "", "run",
         "first reason that holds. `throughput_drop`: gridlocks occur and throughput drops permanently. `teleported`: 1 "
         "% or more of the exited vehicles were teleported. `gridlock`: a gridlock has lasted for six signal cycles "
         "or more at the end. `starvation`: a movement starves (`starvations`). Empty: the run is not unstable"},
        {"collapse_s", "s", "run",
         "time from which the run is unstable. `throughput_drop`: start of the signal cycle from which on throughput "
         "is lower by 10 % or more. `teleported`: end of the last signal cycle with less than 1 % teleported. "
         "`gridlock`: first observation of the gridlock. `starvation`: stop of the first vehicle that starves. Empty: "
         "the run is not unstable"},
        {"gridlocks", "", "run",
         "number of gridlocks: cycles of vehicles that wait for each other. A cycle that shares a vehicle with one "
         "seen within the last signal cycle is the same gridlock"},
        {"first_gridlock_s", "s", "run", "first observation of the first gridlock"},
        {"starvations", "", "run",
         "number of vehicles that stand at the head of a queue for `measure.starvation` or longer, and for two cycles "
         "of their signal, although nothing blocks their way; stopline-run fails if there are any"},
        {"teleported", "veh", "run",
         "vehicles removed by `rules.teleport_cycles`, including those that are not reinserted yet. Imported networks: "
         "missed turns are included"},
        {"passed_blockers", "", "run",
         "number of times that a vehicle passes a blocker in a conflict area, as `rules.pass_blocker_greens` allows; "
         "each pair of a vehicle and a blocker counts once"},
    };
}

std::vector<ColumnDoc> delay_columns() {
    return {
        {"delay_signal_h", "veh h", "run", "delay by red and yellow signals"},
        {"delay_yielding_h", "veh h", "run", "delay by vehicles with priority"},
        {"delay_junction_blocking_h", "veh h", "run", "delay by vehicles that are stopped in a conflict area"},
        {"delay_turn_blocking_h", "veh h", "run", "delay by a full exit lane, if the first vehicle of the queue turns"},
        {"delay_spillback_h", "veh h", "run",
         "delay by a full exit lane, if the first vehicle of the queue goes straight on"},
        {"delay_gridlock_h", "veh h", "run", "delay in a gridlock or behind one"},
        {"delay_wrong_lane_h", "veh h", "run",
         "delay by vehicles that wait for a gap in the adjacent lane, because their route continues there"},
        {"delay_queue_discharge_h", "veh h", "run",
         "delay of vehicles that nothing blocks any more: the leader already moves, or the vehicle closes up to its "
         "queue"},
        {"delay_upstream_h", "veh h", "run",
         "part of the delay by all causes that occurs upstream of the measured area; 0 for imported networks"},
        {"longest_stop_s", "s", "run", "longest single stop of any vehicle"},
        {"longest_in_junction_s", "s", "run",
         "longest time of any vehicle in an intersection, from its front at the stop line to its rear on the exit "
         "lane"},
    };
}

std::vector<ColumnDoc> count_columns() {
    return {
        {"entered", "veh", "run", "vehicles that entered the network"},
        {"exited", "veh", "run", "vehicles that left the network"},
        {"overlaps", "", "run", "vehicles with a net gap below 0, counted in each step; a violation"},
        {"conflicts", "", "run",
         "pairs of vehicles in one conflict area, counted in each step, except passed blockers; a violation"},
        {"red_entries", "veh", "run",
         "vehicles that passed a stop line on red, although they could have stopped; a violation"},
        {"forced_red_entries", "veh", "run",
         "vehicles that passed a stop line on red because they could not stop any more; no violation"},
        {"lost_vehicles", "veh", "run",
         "entered vehicles minus exited vehicles and vehicles present at the end; any value but 0 is a violation"},
        {"missed_turns", "veh", "run",
         "imported networks only: vehicles that reached the stop line in a wrong lane and were teleported"},
        {"backlog", "veh", "end of the run",
         "vehicles that should have entered by then but found no room; 0 for saturated inlets and for queues"},
    };
}

std::vector<ColumnDoc> summary_columns() {
    std::vector<ColumnDoc> columns;
    for (const auto& group : {window_columns(), stability_columns(), delay_columns(), count_columns()}) {
        columns.insert(columns.end(), group.begin(), group.end());
    }
    return columns;
}

std::vector<ColumnDoc> series_columns(const std::vector<ColumnDoc>& summary) {
    std::vector<ColumnDoc> columns{kPopulationColumn, {"from_s", "s", "", "start of the interval"}};
    for (const ColumnDoc& column : summary) {
        const bool is_measured = column.name == "throughput_veh_h" || column.name == "travel_time_s" ||
                                 column.name == "density_percent" || column.name == "vehicles_in_area";
        const bool is_delay = column.name.starts_with("delay_") && column.name != "delay_upstream_h";
        if (is_measured) columns.push_back({column.name, column.unit, "interval, area", column.meaning});
        if (is_delay || column.name == "teleported") {
            columns.push_back({column.name, column.unit, "interval, network", column.meaning});
        }
    }
    return columns;
}

std::vector<TableDoc> result_tables() {
    const std::vector<ColumnDoc> summary = summary_columns();
    return {
        {"network/summary.csv",
         "Grids, streets and imported networks. One row for each population.\n\n"
         "The delay by a cause is the time for which it stops vehicles, including the queue behind the first one.\n"
         "The sum over all causes is the time that vehicles are stopped.",
         summary},
        {"network/series.csv", "One row for each population and interval of the whole run.", series_columns(summary)},
        {"network/origin_destination.csv",
         "One row for each population and pair of sides with traffic. Imported networks have no rows.",
         {kPopulationColumn,
          {"from", "", "", "side on which vehicles enter the area: west, south, east or north"},
          {"to", "", "", "side on which these vehicles leave it: west, south, east or north"},
          {"throughput_veh_h", "veh/h", "window", "vehicles of this pair that leave the area"},
          {"travel_time_s", "s", "window", "mean time of these vehicles in the area"}}},
        {"network/delays.csv",
         "One row for each episode: a period in which one cause delays the traffic of one lane without interruption.\n"
         "For `signal`, `yielding` and `queue_discharge`, a vehicle counts only after a stop of two signal cycles.",
         {kPopulationColumn,
          {"cause", "", "",
           "`signal`, `yielding`, `junction_blocking`, `turn_blocking`, `spillback`, `gridlock`, `wrong_lane` or "
           "`queue_discharge`; see the columns `delay_CAUSE_h` of `network/summary.csv`"},
          {"lane", "", "", "lane of the first delayed vehicle; the queue can reach back over further lanes"},
          {"vehicle", "", "", "first delayed vehicle when the episode began"},
          {"blocker", "", "", "vehicle for which the first delayed vehicle waited at that time; empty: none"},
          {"blocker_lane", "", "", "lane of the blocker at that time"},
          {"from_s", "s", "run", "first observation; vehicles are observed every second"},
          {"to_s", "s", "run", "last observation"},
          {"max_vehicles", "veh", "run", "largest number of delayed vehicles: the first one and its queue"},
          {"delay_s", "veh s", "run", "sum of the delays of these vehicles"}}},
        {"network/starvations.csv",
         "One row for each vehicle that stands at the head of a queue for `measure.starvation` or longer although "
         "nothing blocks\nits way. Its movement starves.",
         {kPopulationColumn,
          {"lane", "", "", "lane of the vehicle"},
          {"vehicle", "", "", "number of the vehicle"},
          {"cause", "", "",
           "cause of its delay at the last observation: `signal`, `yielding`, `wrong_lane` or `queue_discharge`"},
          {"from_s", "s", "run", "time at which the vehicle stopped"},
          {"to_s", "s", "run", "last observation; vehicles are observed every second"}}},
        {"network/gridlocks.csv",
         "One row for each vehicle of a gridlock. Each vehicle waits for the one in the next row, and the last for "
         "the first.",
         {kPopulationColumn,
          {"gridlock", "", "", "number of the gridlock, from 1"},
          {"from_s", "s", "run", "first observation"},
          {"to_s", "s", "run", "last observation"},
          {"vehicle", "", "", "vehicle at the last observation"},
          {"lane", "", "", "lane of the vehicle"}}},
    };
}

std::vector<TableDoc> rule_and_vehicle_tables() {
    return {
        {"network/rules.csv",
         "One row for each use of a traffic rule (`rules`), in the order of time. A teleport has two rows.",
         {kPopulationColumn,
          {"time_s", "s", "run", "time of the use"},
          {"rule", "", "",
           "`teleported`: the vehicle is removed (`teleport_cycles`, or a missed turn). `reinserted`: it is put on "
           "the road behind the obstruction. `passed_blocker`: a vehicle passes a blocker (`pass_blocker_greens`). "
           "`keep_clear`: a vehicle is held at a green signal (`keep_clear`); one row when it begins"},
          {"vehicle", "", "", "vehicle that is removed, reinserted, passes or is held"},
          {"lane", "", "", "lane of the vehicle; `passed_blocker`: its connection through the intersection"},
          {"blocker", "", "", "vehicle that is passed or that blocks the way; empty: none"},
          {"stopped_s", "s", "",
           "`teleported`, `reinserted`: time for which the vehicle has been stopped. `keep_clear`: time for which the "
           "blocker has been stopped. `passed_blocker`: time for which the blocker had been stopped when passing was "
           "allowed"}}},
        {"network/inflow.csv",
         "Streets only. One row for each population and interval.",
         {kPopulationColumn,
          {"from_s", "s", "", "start of the interval"},
          {"west_veh_h", "veh/h", "interval, area", "vehicles that enter the area from the west"},
          {"south_veh_h", "veh/h", "interval, area", "vehicles that enter the area from the south"},
          {"east_veh_h", "veh/h", "interval, area", "vehicles that enter the area from the east"},
          {"north_veh_h", "veh/h", "interval, area", "vehicles that enter the area from the north"}}},
        {"network/approaches.csv",
         "Streets only. One row for each population, approach and interval. Vehicles are sampled every second.",
         {kPopulationColumn,
          {"approach", "", "", "name of the approach: the name of its lanes without their number"},
          {"from_s", "s", "", "start of the interval"},
          {"vehicles", "veh", "interval", "mean number of vehicles on the approach"},
          {"speed_kmh", "km/h", "interval", "mean speed of these vehicles; empty: no vehicle"},
          {"upstream_speed_kmh", "km/h", "interval",
           "mean speed in the upstream third of the approach; empty: no vehicle"}}},
        {"network/turns.csv",
         "Streets only. One row for each population and approach.",
         {kPopulationColumn,
          {"approach", "", "", "name of the approach: the name of its lanes without their number"},
          {"vehicles", "veh", "run", "vehicles that entered the intersection from the approach"},
          {"right_percent", "%", "run", "share of these vehicles that turned right"},
          {"right_target_percent", "%", "", "share that the streets file sets"},
          {"left_percent", "%", "run", "share of these vehicles that turned left"},
          {"left_target_percent", "%", "", "share that the streets file sets"},
          {"congested_from_s", "s", "run",
           "time from which the mean speed in the upstream third of the approach is below 12 km/h for five "
           "successive intervals; empty: never"}}},
        {"network/time_space.csv",
         "Written if `measure.time_space` is set, for the last `measure.time_space` of the run.\n"
         "One row for each second and vehicle on one street, which begins on the side `measure.time_space_side`.",
         {kPopulationColumn,
          {"time_s", "s", "run", "time of the sample"},
          {"vehicle", "", "", "number of the vehicle"},
          {"policy", "", "", "spacing policy of the vehicle"},
          {"position_m", "m", "", "distance of its front from the start of the first lane of the street"}}},
        {"network/trajectories.csv",
         "Written with `--trajectories`. One row for each vehicle in the network and each `--interval`.",
         {kPopulationColumn,
          {"time_s", "s", "run", "time of the sample"},
          {"vehicle", "", "", "number of the vehicle"},
          {"policy", "", "", "spacing policy of the vehicle"},
          {"lane", "", "", "lane of its front; beyond the stop line, its connection"},
          {"position_m", "m", "",
           "distance of its front from the start of the lane; on a connection: from the stop line"},
          {"x_m", "m", "", "position of its front toward the east"},
          {"y_m", "m", "", "position of its front toward the north"},
          {"speed_mps", "m/s", "", "speed"},
          {"acceleration_mps2", "m/s2", "", "acceleration"}}},
    };
}

}  // namespace

std::vector<TableDoc> network_table_docs() {
    std::vector<TableDoc> tables = result_tables();
    for (TableDoc& table : rule_and_vehicle_tables()) tables.push_back(std::move(table));
    return tables;
}

}  // namespace stopline

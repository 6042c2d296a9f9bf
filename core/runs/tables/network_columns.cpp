// Descriptions of the columns in the tables of grids, streets and imported networks.
#include <utility>

#include "runs/metrics/metric_groups.h"
#include "runs/tables/column_docs.h"
#include "scenario/kinds/network_kind.h"

namespace stopline {

namespace {

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
    const std::vector<ColumnDoc>& summary = metric_group(kRunAsNetwork).summary;
    return {
        {"network/summary.csv",
         "Grids, streets and imported networks. One row for each population.\n\n"
         "The delay by a cause is the time for which it stops vehicles, including the queue behind the first one.\n"
         "The sum over all causes is the time that vehicles are stopped.",
         with_population(summary)},
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
           "`signal`, `yielding`, `junction_blocking`, `turn_blocking`, `spillback`, `gridlock`, `wrong_lane`, "
           "`queue_discharge` or `refusal`; see the columns `delay_CAUSE_h` of `network/summary.csv`"},
          {"lane", "", "", "lane of the first delayed vehicle; the queue can reach back over further lanes"},
          {"vehicle", "", "",
           "the vehicle that was first in the queue when the episode began: its number, or SUMO's id in imported networks"},
          {"blocker", "", "",
           "the vehicle for which it waited at that time: its number, or SUMO's id in imported networks; empty: none"},
          {"blocker_lane", "", "", "lane of the blocker at that time"},
          {"from_s", "s", "run", "first observation; vehicles are observed every second"},
          {"to_s", "s", "run", "last observation"},
          {"max_vehicles", "veh", "run", "largest number of delayed vehicles: the first one and its queue"},
          {"delay_s", "veh s", "run", "sum of the delays of these vehicles"}}},
        {"network/lane_delays.csv",
         "The episodes of `network/delays.csv`, added up. One row for each lane and cause.",
         {kPopulationColumn,
          {"lane", "", "", "lane of the first vehicle of the queue; the queue can reach back over further lanes"},
          {"cause", "", "", "cause of the delay, as in `network/delays.csv`"},
          {"episodes", "", "run", "number of episodes"},
          {"delay_s", "veh s", "run", "sum of the delays of all vehicles in these episodes"}}},
        {"network/v2v_modes.csv",
         "Written if `driver.v2v` sets a channel. One row for each change of a vehicle's driving mode because of the age "
         "of\nthe newest message from its leader, or from its platoon leader.",
         {kPopulationColumn,
          {"time_s", "s", "run", "time of the change"},
          kVehicleColumn,
          {"leader", "", "", "number of its leader; SUMO's id in imported networks"},
          {"from", "", "", "mode before: `platoon_leader`, `messages`, `old_messages`, `radar` or `acc`"},
          {"to", "", "", "mode after the change"},
          {"message_age_s", "s", "", "age of the newest message; empty: no message has arrived from this leader"},
          {"net_gap_m", "m", "", "gap to the rear of the leader, from radar"},
          {"speed_mps", "m/s", "", "speed of the vehicle"}}},
        {"network/starvations.csv",
         "One row for each starving vehicle. It is the first vehicle of the queue nearest to the end of its lane for\n"
         "`measure.starvation` or longer, and nothing blocks its way.",
         {kPopulationColumn,
          {"lane", "", "", "lane of the vehicle"},
          kVehicleColumn,
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
          {"vehicle", "", "",
           "a vehicle of the gridlock at its last observation: its number, or SUMO's id in imported networks"},
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
           "`keep_clear`: a vehicle is held at a green signal (`keep_clear`); one row when it begins. `refused`: a "
           "vehicle is held at a green signal (`clearing`); one row when it begins"},
          {"vehicle", "", "",
           "number of the vehicle that is removed, reinserted, passes or is held; SUMO's id in imported networks"},
          {"lane", "", "", "lane of the vehicle; `passed_blocker`: its connection through the intersection"},
          {"blocker", "", "",
           "number of the vehicle that is passed or that blocks the way; SUMO's id in imported networks; empty: none"},
          {"stopped_s", "s", "",
           "`teleported`, `reinserted`: time for which the vehicle has been stopped. `keep_clear`, `refused`: time for which the "
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
           "successive intervals; empty: never"},
          {"departure_delay_mean_s", "s", "run",
           "mean time from the arrival of a vehicle to its entry; empty: no vehicle has an arrival time, or none "
           "enters here"},
          {"departure_delay_max_s", "s", "run", "longest of these times"}}},
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
          kVehicleColumn,
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

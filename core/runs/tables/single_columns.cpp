// Descriptions of the columns in the tables of a single intersection and of a single light.
#include "runs/tables/column_docs.h"

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

std::vector<ColumnDoc> joined(std::vector<ColumnDoc> first, const std::vector<ColumnDoc>& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

}  // namespace

std::vector<TableDoc> intersection_table_docs() {
    const std::vector<TableDoc> network = network_table_docs();
    const auto as_network = [&](std::string_view column) { return column_doc(network, "network/summary.csv", column); };
    const auto as_starving = [&](std::string_view column) {
        return column_doc(network, "network/starvations.csv", column);
    };
    return {
        {"intersection/summary.csv",
         "One row for each population. The window is `measure.cycles` whole cycles after `measure.warmup_cycles`.",
         {kPopulationColumn,
          {"throughput_veh_h", "veh/h", "window", "vehicles that leave the intersection"},
          {"improvement_percent", "%", "window",
           "gain in throughput over `measure.baseline`; empty without a baseline"},
          {"travel_time_RADIUSm_s", "s", "window",
           "mean time within this radius (`measure.zones`), over the vehicles that leave the circle"},
          {"delay_RADIUSm_s", "s", "window", "`travel_time_RADIUSm_s` minus the travel time at the speed limit"},
          {"density_RADIUSm_percent", "%", "window", "share of the lane length within the radius that vehicles occupy"},
          {"density_network_percent", "%", "window",
           "share of the lane length of the whole network that vehicles occupy"},
          {"vehicles_present", "veh", "window", "mean number of vehicles in the network, sampled every second"},
          {"vehicles_per_green", "veh", "window",
           "mean number of vehicles that pass a stop line in one green and its yellow"},
          {"saturated_greens", "", "window",
           "number of greens, summed over the lanes, in which five or more vehicles of a queue pass. Only vehicles "
           "that were slower than 5 km/h before the stop line are of the queue, and it ends before the first other "
           "vehicle"},
          {"saturation_flow_veh_h", "veh/h", "window",
           "flow at the mean headway from the fifth vehicle of a queue on; empty: no saturated green"},
          {"startup_lost_time_s", "s", "window",
           "sum over the first four vehicles of a queue: headway minus the mean headway of the lane from the fifth "
           "vehicle on; mean over saturated greens"},
          {"queue_veh", "veh", "window", "queued vehicles at the start of green, mean over lanes and greens"},
          {"longest_queue_m", "m", "window", "longest of these queues"},
          {"turned_right_percent", "%", "window", "share of the vehicles that leave the intersection to the right"},
          {"turned_left_percent", "%", "window", "share of the vehicles that leave the intersection to the left"},
          as_network("longest_in_junction_s"),
          as_network("starvations"),
          as_network("overlaps"),
          as_network("conflicts"),
          as_network("red_entries"),
          as_network("forced_red_entries"),
          as_network("lost_vehicles"),
          {"deadlocks", "", "run",
           "1 if a vehicle stays in the intersection for two cycles longer than the slowest unobstructed crossing "
           "takes, else 0; a violation"}}},
        {"intersection/headways.csv",
         "One row for each population, lane and queue position. Only vehicles that stood in the queue count.",
         {kPopulationColumn,
          {"lane", "", "", "approach lane"},
          {"position", "", "", "position in the queue, from 1"},
          {"headway_s", "s", "window", "mean headway over greens; first position: time since the start of green"},
          {"samples", "", "window", "number of headways in the mean"}}},
        {"intersection/starvations.csv",
         "One row for each starving vehicle, as in `network/starvations.csv`.",
         {kPopulationColumn, as_starving("lane"), as_starving("vehicle"), as_starving("cause"), as_starving("from_s"),
          as_starving("to_s")}},
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
    const std::vector<TableDoc> network = network_table_docs();
    const auto as_network = [&](std::string_view column) { return column_doc(network, "network/summary.csv", column); };
    return {
        {"single_light/summary.csv",
         "One row for each population.",
         {kPopulationColumn,
          {"passed_in_green_veh", "veh", "green", "vehicles that pass the stop line"},
          {"queue_emptied_s", "s", "green",
           "time from the start of green until the last queued vehicle passes the stop line; empty: it does not pass "
           "within the green"},
          {"steady_vehicles", "veh", "green",
           "followers in steady state downstream of the stop line: at the cruise speed for five seconds, with a net "
           "gap that changes by 0.1 m or less and is at most 25 % and 0.5 m larger than that of the policy. The cruise "
           "speed is that of a vehicle without leader: the speed limit in full dynamics, and "
           "`meso.leader_speed_share` of `meso.speed_factor` times the limit in the mesoscale mode"},
          {"not_closed_up_vehicles", "veh", "green",
           "followers downstream of the stop line that keep a larger net gap for five seconds, at the cruise speed or "
           "faster. They have not reached the gap of their policy"},
          {"steady_net_gap_m", "m", "green", "mean net gap of these vehicles"},
          {"policy_gap_m", "m", "", "net gap of the spacing policy at the cruise speed"},
          {"steady_headway_s", "s", "green", "mean headway of these vehicles: (length + net gap) / speed"},
          {"policy_headway_s", "s", "", "headway of the spacing policy at the cruise speed"},
          {"headway_deviation_percent", "%", "green", "deviation of `steady_headway_s` from `policy_headway_s`"},
          {"asymptotic_improvement_percent", "%", "green",
           "improvement over `measure.baseline` for very long queues, from the steady-state headways; empty without a "
           "baseline"},
          {"last_ten_headway_s", "s", "green", "mean headway at the stop line over the last ten vehicles of each lane"},
          {"last_ten_speed_mps", "m/s", "green", "mean speed at the stop line over the last ten vehicles of each lane"},
          {"leader_start_s", "s", "green", "time from the start of green until the first vehicle moves"},
          {"leader_time_to_limit_s", "s", "green",
           "time from this start until the first vehicle reaches the speed limit"},
          {"queue_gap_mean_m", "m", "start of green", "mean net gap in the queue"},
          {"queue_gap_smallest_m", "m", "start of green", "smallest net gap in the queue"},
          {"queue_gap_largest_m", "m", "start of green", "largest net gap in the queue"},
          {"vehicles_entered", "veh", "run", "vehicles that entered the network"},
          {"vehicles_exited", "veh", "run", "vehicles that left the network"},
          as_network("overlaps"),
          as_network("red_entries"),
          as_network("forced_red_entries"),
          as_network("lost_vehicles"),
          {"state_hash", "", "end of the run", "hash of the final state; equal runs give equal hashes"}}},
        {"single_light/improvement.csv",
         "One row for each population and each green time of `measure.green`.",
         {kPopulationColumn,
          {"green_s", "s", "", "green time"},
          {"passed_veh", "veh", "green", "vehicles that pass the stop line within this time"},
          {"baseline", "", "", "name of the baseline population; empty without one"},
          {"baseline_passed_veh", "veh", "green", "vehicles of the baseline that pass the stop line within this time"},
          {"improvement_percent", "%", "green", "gain of `passed_veh` over `baseline_passed_veh`"}}},
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

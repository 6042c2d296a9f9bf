// Descriptions of the columns of hcm.csv and hcm_headways.csv.
#include "runs/tables/column_docs.h"

namespace stopline {

std::vector<ColumnDoc> hcm_columns() {
    return {
        kPopulationColumn,
        {"scope", "", "", "`lane`, `approach` or `intersection`. Columns without a meaning for the last two are empty"},
        {"name", "", "", "name of the lane or approach, or number of the intersection from 0"},
        {"cycles", "", "window",
         "number of cycles that lie completely in the window; all values cover them. A cycle of a lane ends at the "
         "start of red after its last green in a cycle of the controller. If no green of the lane ends in a cycle of "
         "the controller, the cycle of the lane ends with that of the controller: the controller has then skipped the "
         "lane, or the green goes on"},
        {"cycle_s", "s", "window", "mean length of these cycles"},
        {"green_s", "s", "window",
         "mean green time in a cycle: the sum, if the lane has several greens in a cycle. A cycle without green counts "
         "as 0 s"},
        {"saturated_greens", "", "window",
         "greens in which five or more vehicles of a queue pass. Below 5 greens, saturation flow and lost time are "
         "means of all lanes"},
        {"saturation_flow_veh_h", "veh/h", "window", "flow at the mean headway from the fifth vehicle of a queue on"},
        {"startup_lost_time_s", "s", "window", "start-up lost time of the first four vehicles of a queue"},
        {"end_gain_s", "s", "window",
         "mean time from the end of green to the passage of the last queued vehicle, in greens in which the queue does not clear; below 5 such "
         "greens the mean of all lanes, or 2 s if all lanes have fewer than 5"},
        {"effective_green_s", "s", "window",
         "sum over the greens of a cycle: green minus start-up lost time plus end gain"},
        {"capacity_veh_h", "veh/h", "window", "saturation flow times effective green, divided by the cycle"},
        {"volume_veh_h", "veh/h", "window",
         "vehicles that arrive: `passed_veh_h` plus the growth of the number of vehicles before the stop line. "
         "At a saturated inlet, the vehicles that enter"},
        {"passed_veh_h", "veh/h", "window", "vehicles that pass the stop line"},
        {"degree_of_saturation", "", "window",
         "`volume_veh_h` divided by `capacity_veh_h`; approach and intersection: the highest of their lanes"},
        {"control_delay_s", "s", "window", "measured mean control delay of the vehicles that pass"},
        {"formula_delay_s", "s", "window",
         "control delay by the formula: sum of the next three columns. Empty for a lane with several greens in a "
         "cycle, and for its approach and intersection, because the formulas assume a single green. The next three "
         "columns and all other `formula_` columns are then empty, too"},
        {"uniform_delay_s", "s", "window", "uniform delay d1"},
        {"incremental_delay_s", "s", "window", "incremental delay d2 for random arrivals, over the measured time"},
        {"initial_queue_delay_s", "s", "window", "delay d3 caused by the queue at the start of the first cycle"},
        {"stops_per_vehicle", "", "window",
         "mean number of stops before the stop line. A vehicle stops when its speed falls below 5 km/h; it can stop "
         "again after 10 km/h"},
        {"queue_50_veh", "veh", "window",
         "median over the cycles of the back of queue: the queue at the start of red, and the vehicles that join it. "
         "With several greens in a cycle, the longest of their queues. Cycles without green count, too"},
        {"queue_95_veh", "veh", "window", "95th percentile of the same"},
        {"formula_queue_50_veh", "veh", "window", "mean back of queue by the formula"},
        {"formula_queue_95_veh", "veh", "window", "95th percentile of the back of queue by the formula"},
        {"queue_50_m", "m", "window",
         "median over the cycles of the greatest distance from the stop line to the rear of a queued vehicle"},
        {"queue_95_m", "m", "window", "95th percentile of the same; at most the length of the lane"},
        {"residual_queue_percent", "%", "window", "share of the cycles after which a part of the queue remains"},
        {"state", "", "window",
         "`free`: the queue clears in more than half of the cycles; `saturated`: a queue remains after half of the cycles or more; `oversaturated`: the degree of "
         "saturation exceeds 1, or the inlet is saturated and queues remain. Delay then depends on the length of the run"},
        {"level_of_service", "", "window",
         "level of service A to F of the measured delay; a lane that is oversaturated has F. Empty: no vehicle"},
        {"formula_level_of_service", "", "window", "the same for the delay by the formula"}};
}

std::vector<ColumnDoc> hcm_headway_columns() {
    return {kPopulationColumn,
            {"lane", "", "", "lane with a stop line"},
            {"position", "", "", "position in the queue, from 1"},
            {"headway_s", "s", "window", "mean headway; first position: time since the start of green"},
            {"samples", "", "window", "number of headways in the mean"}};
}

std::vector<TableDoc> hcm_table_docs() {
    std::vector<TableDoc> all;
    for (const char* const name : {"network/hcm.csv", "intersection/hcm.csv", "single_light/hcm.csv"}) {
        all.push_back({name,
                       "Written with `measure.hcm: on`. One row for each population and lane, then for each approach "
                       "and intersection.\nThe page [HCM.md](HCM.md) explains the measures.",
                       hcm_columns()});
    }
    for (const char* const name :
         {"network/hcm_headways.csv", "intersection/hcm_headways.csv", "single_light/hcm_headways.csv"}) {
        all.push_back({name, "Written with `measure.hcm: on`. One row for each population, lane and queue position.",
                       hcm_headway_columns()});
    }
    return all;
}

}  // namespace stopline

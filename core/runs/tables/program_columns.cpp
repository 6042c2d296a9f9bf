// Descriptions of the columns in the tables of stopline-run --greens, stopline-calibrate, stopline-startup,
// stopline-compare, stopline-scorecard and stopline-signals.
#include "runs/tables/column_docs.h"

#include <utility>

namespace stopline {

namespace {

std::vector<TableDoc> calibration_tables() {
    const ColumnDoc permutation{"permutation", "", "", "axis values of the sweep, as text"};
    const ColumnDoc held_out{"held_out", "", "", "1 if the permutation is held out of the fit, else 0"};
    const ColumnDoc detector{"detector", "", "", "lane and kind of the detector"};
    const ColumnDoc unpaired{"unpaired", "", "run", "passages of one fidelity without a partner in the other"};
    return {
        {"calibrate/permutations.csv",
         "Step I. One row for each permutation and parameter set. A pair is the k-th passage of a detector in both "
         "fidelities.",
         {permutation,
          held_out,
          {"parameters", "", "", "name of the parameter set"},
          {"pairs", "", "run", "number of pairs"},
          unpaired,
          {"within_limit_percent", "%", "run",
           "share of pairs that differ by 1 s or less; unpaired passages count as differing by more"},
          {"median_difference_s", "s", "run", "median of the absolute differences"},
          {"p95_difference_s", "s", "run", "95th percentile of the absolute differences"},
          {"largest_difference_s", "s", "run", "largest absolute difference"},
          {"pairs_in_other_green", "", "run", "pairs that differ by half a signal cycle or more"}}},
        {"calibrate/differences.csv",
         "Step I, last parameter set. One row for each pair.",
         {permutation,
          held_out,
          detector,
          {"passage", "", "", "number of the passage, from 1"},
          {"full_s", "s", "run", "time of the passage in full dynamics"},
          {"meso_s", "s", "run", "time of the passage in the mesoscale mode"},
          {"difference_s", "s", "run", "`meso_s` minus `full_s`"}}},
        {"calibrate/misses.csv",
         "Step I, last parameter set. One row for each detector with pairs beyond the limit or unpaired passages.",
         {permutation,
          held_out,
          detector,
          {"pairs_beyond_limit", "", "run", "pairs that differ by more than 1 s"},
          {"pairs", "", "run", "number of pairs"},
          unpaired,
          {"first_passage", "", "", "number of the first passage beyond the limit, from 1"},
          {"largest_difference_s", "s", "run", "largest difference, with its sign"},
          {"cause", "", "", "probable cause"},
          {"accepted", "", "", "reason in the file of accepted differences; empty: not accepted"}}},
        {"calibrate/fit_history.csv",
         "Step I. One row for each evaluation of the fit.",
         {{"evaluation", "", "", "number of the evaluation, from 1"},
          {"search", "", "", "name of the search"},
          {"loss", "", "", "mean loss of all pairs, from 0 to 1"},
          {"PARAMETER", "SI unit", "", "value of the parameter of the mesoscale mode"}}},
        {"calibrate/bands_NAME.csv",
         "Step II. One row for each permutation and metric. NAME is the parameter set.",
         {permutation,
          {"metric", "", "", "column of `sweep/NAME.csv`"},
          {"full_mean", "of the metric", "seeds", "mean of full dynamics"},
          {"meso_mean", "of the metric", "seeds", "mean of the mesoscale mode"},
          {"paper_low", "of the metric", "seeds",
           "lower bound of the confidence band of full dynamics, by equation (2)"},
          {"paper_high", "of the metric", "seeds", "upper bound of this band"},
          {"student_low", "of the metric", "seeds", "lower bound of the Student confidence interval of full dynamics"},
          {"student_high", "of the metric", "seeds", "upper bound of this interval"},
          {"inside_paper", "", "seeds", "1 if `meso_mean` is between `paper_low` and `paper_high`, else 0"},
          {"inside_student", "", "seeds", "1 if `meso_mean` is between `student_low` and `student_high`, else 0"}}},
    };
}

std::vector<TableDoc> other_program_tables() {
    return {
        {"run/greens.csv",
         "Written with `stopline-run --greens FILE`, for all kinds of networks. One row for each green of each signal "
         "group, in the order of their ends; greens that have not ended come last. Groups without lanes, such as those "
         "of pedestrians, have no rows.",
         with_population(
             {{"intersection", "", "", "number of the intersection from 0; equal to its `name` in `hcm.csv`"},
              {"group", "", "", "number of the signal group at this intersection"},
              {"lanes", "", "",
               "approach lanes that the group controls, separated by spaces; "
               "for a group that controls single movements: their connections"},
              {"start_s", "s", "run", "start of green; below 0: the green began before the run"},
              {"end_s", "s", "run",
               "end of green, at which yellow begins; empty: the green had not ended by the end of the run"},
              {"green_s", "s", "run", "duration of green; empty if `end_s` is empty"},
              {"red_before_s", "s", "run",
               "time from the end of the previous green of the group to this start, yellow included; "
               "empty: the first green of the group"}})},
        {"startup/startup.csv",
         "One row for each time of the measured starts.",
         {{"time_s", "s", "", "time since the vehicle started to move"},
          {"simulated_kmh", "km/h", "", "simulated speed"},
          {"measured_mean_kmh", "km/h", "", "mean speed of the measured starts"},
          {"mean_ci95_kmh", "km/h", "", "half width of the 95 % confidence interval of this mean"},
          {"p2.5_kmh", "km/h", "", "2.5th percentile of the measured starts"},
          {"p97.5_kmh", "km/h", "", "97.5th percentile of the measured starts"},
          {"gear", "", "", "engaged gear of the simulated vehicle"},
          {"distance_m", "m", "", "distance that the simulated vehicle has covered"}}},
        {"startup/startup_fine.csv",
         "The simulated start in small time steps.",
         {{"time_s", "s", "", "time since the vehicle started to move"},
          {"simulated_kmh", "km/h", "", "simulated speed"},
          {"gear", "", "", "engaged gear"}}},
        {"compare/comparison.csv",
         "One row for each metric and seed.",
         {{"metric", "", "",
           "name of the metric with its unit. `departure_delay_s`: imported networks, time from the planned "
           "departure to the entry; other networks, how much later a vehicle enters in SUMO than in the mesoscale "
           "mode. `backlog`: vehicles that have not entered at the end"},
          {"seed", "", "", "seed of both runs"},
          {"ours", "of the metric", "window", "value of the mesoscale mode"},
          {"sumo", "of the metric", "window", "value of SUMO"}}},
        {"compare/stop_lines.csv",
         "One row for each stop line.",
         {{"lane", "", "", "lane that ends at the stop line"},
          {"ours_veh", "veh", "window", "passages in the mesoscale mode, mean over the seeds"},
          {"sumo_veh", "veh", "window", "passages in SUMO, mean over the seeds"}}},
        {"scorecard/scorecard.csv",
         "One row for each number or claim of the paper, and for each result of ours that the paper does not have.",
         {{"id", "", "", "row of `data/paper/targets.csv` or `data/paper/own_rows.csv`"},
          {"section", "", "", "section of the paper; `coordination`: not in the paper"},
          {"paper", "", "", "value or claim of the paper; empty: not in the paper"},
          {"ours", "", "", "value or result of this project; empty: no result"},
          {"unit", "", "", "unit of both values"},
          {"tolerance", "", "", "allowed difference"},
          {"verdict", "", "",
           "`inside` the tolerance, `miss`, `open` (no result or no tolerance), `input` of the paper, or `own` (not in the "
           "paper)"},
          {"explanation", "", "", "how the value is measured, and why it misses the paper's value"}}},
    };
}

std::vector<TableDoc> signal_timing_tables() {
    const ColumnDoc level{"level_of_service", "", "", "level of service by the HCM, A to F"};
    return {
        {"signals/timing.csv",
         "One row for each population. Cells of times are empty if the demand is too high for a timing.",
         with_population({{"flow_ratio_sum", "", "", "sum of the critical flow ratios of both streets"},
                          {"lost_time_s", "s", "", "lost time in each cycle"},
                          {"webster_cycle_s", "s", "", "Webster's cycle, before greens are rounded"},
                          {"cycle_s", "s", "", "cycle"},
                          {"green_s", "s", "", "green of the streets from west to east, `signal.green`"},
                          {"cross_green_s", "s", "", "green of the streets from south to north, `signal.cross_green`"},
                          {"offset_s", "s", "", "`signal.offset`; empty for a single intersection"},
                          {"saturation_degree", "", "", "highest degree of saturation of a lane: demand over capacity"},
                          {"delay_s", "s", "", "mean control delay of all vehicles by the HCM"},
                          level})},
        {"signals/lanes.csv",
         "One row for each population, street, and place of a lane in its approach. The demand is that of the lane with "
         "the most demand.",
         with_population(
             {{"street", "", "", "`west-east` or `south-north`"},
              {"lane", "", "", "place of the lane in its approach; 0: leftmost"},
              {"busiest_lane", "", "", "name of the lane with the most demand"},
              {"demand_veh_h", "veh/h", "", "demand of this lane"},
              {"left_percent", "%", "", "share of its vehicles that turn left"},
              {"right_percent", "%", "", "share of its vehicles that turn right"},
              {"saturation_flow_veh_h", "veh/h", "saturated run", "measured saturation flow"},
              {"flow_ratio", "", "", "demand over saturation flow"},
              {"critical", "", "", "1 if the flow ratio is the highest of the street, else 0"},
              {"startup_lost_time_s", "s", "saturated run", "measured start-up lost time of the street"},
              {"lost_time_s", "s", "saturated run",
               "lost time of the street in each cycle: start-up lost time, yellow and all red, minus the part of these "
               "that vehicles use"},
              {"green_s", "s", "", "displayed green"},
              {"effective_green_s", "s", "", "green, yellow and all red minus `lost_time_s`"},
              {"capacity_veh_h", "veh/h", "", "capacity"},
              {"capacity_variance_ratio", "", "saturated run",
               "variance of the number of vehicles that pass in a green, over its mean; 0 for lanes without left "
               "turns"},
              {"saturation_degree", "", "", "demand over capacity"},
              {"uniform_delay_s", "s", "", "uniform delay d1 of the HCM"},
              {"incremental_delay_s", "s", "",
               "incremental delay d2 of the HCM, for random arrivals and with the variance of the capacity"},
              {"delay_s", "s", "", "d1 plus d2"},
              level})},
    };
}

std::vector<TableDoc> signal_search_tables() {
    const std::string objective_unit = "of the objective";
    return {
        {"signals/search_POPULATION.csv",
         "With `--search`. One row for each run.",
         {{"point", "", "", "number of the run"},
          {"green_s", "s", "", "`signal.green`"},
          {"cross_green_s", "s", "", "`signal.cross_green`"},
          {"offset_s", "s", "", "`signal.offset`; only for several intersections"},
          kPopulationColumn,
          {"seed", "", "", "seed of the run"},
          {"delay_s", "s", "last 75 % of the run",
           "delay per vehicle that leaves: time in which vehicles do not drive at the speed limit, and time in which they "
           "wait to enter"},
          {"throughput_veh_h", "veh/h", "last 75 % of the run", "vehicles that leave the network"},
          {"backlog", "veh", "end of the run", "vehicles that should have entered by then but found no room"},
          {"overlaps", "", "run", "overlapping vehicles"},
          {"red_entries", "", "run", "avoidable entries on red"},
          {"lost_vehicles", "veh", "run", "entered minus exited minus present vehicles"},
          {"updates", "", "run", "number of vehicles in the network, summed over all steps"},
          {"state_hash", "", "end of the run", "hash of the final state"}}},
        {"signals/search.csv", "With `--search`. One row for each population and setting, with means over the seeds.",
         with_population(
             {{"green_s", "s", "", "`signal.green`"},
              {"cross_green_s", "s", "", "`signal.cross_green`"},
              {"offset_s", "s", "", "`signal.offset`"},
              {"cycle_s", "s", "", "cycle"},
              {"runs", "", "", "number of seeds"},
              {"delay_s", "s", "seeds", "mean of `delay_s`"},
              {"throughput_veh_h", "veh/h", "seeds", "mean of `throughput_veh_h`"},
              {"objective", "", "", "column that the search optimises"},
              {"mean", objective_unit, "seeds", "its mean"},
              {"ci95_low", objective_unit, "seeds", "lower bound of its 95 % confidence interval; empty for one seed"},
              {"ci95_high", objective_unit, "seeds", "upper bound of this interval"},
              {"difference", objective_unit, "seeds", "mean difference to the start values, by seed"},
              {"difference_ci95_low", objective_unit, "seeds", "lower bound of its 95 % confidence interval"},
              {"difference_ci95_high", objective_unit, "seeds", "upper bound of this interval"},
              {"is_start", "", "", "1 for the start values, else 0"}})},
    };
}

}  // namespace

std::vector<TableDoc> program_table_docs() {
    std::vector<TableDoc> tables = calibration_tables();
    for (TableDoc& table : other_program_tables()) tables.push_back(std::move(table));
    for (TableDoc& table : signal_timing_tables()) tables.push_back(std::move(table));
    for (TableDoc& table : signal_search_tables()) tables.push_back(std::move(table));
    return tables;
}

}  // namespace stopline

// Coordination between vehicles, which the paper names as future work (rows K01 to K15 of data/paper/own_rows.csv). The
// values come from two sweeps in the mesoscale mode: the grid with turns, and Berlin with four lanes. Section
// "coordination" of the scorecard has no values of the paper.
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "paper/sections/scorecard_sections.h"
#include "paper/sections/sweep_means.h"

namespace stopline {

namespace {

constexpr const char* kClearingGrid = "clearing_grid";
constexpr const char* kFourLanes = "coordination_four_lanes";

// Measured columns of the sweep results (sweep_means.h).
constexpr std::array<const char*, 8> kCoordinationColumns{
    "throughput_veh_h",      "gridlocks",       "teleported",       "delay_junction_blocking_h",
    "delay_turn_blocking_h", "delay_refusal_h", "delay_gridlock_h", "delay_wrong_lane_h"};

std::string runs_on_grid(bool clearing, int green_s, const std::string& population) {
    return fmt::format("{} {} {}", clearing ? "with" : "without", green_s, population);
}
std::string runs_in_berlin(bool coordination, const std::string& population) {
    return fmt::format("{} {}", coordination ? "with" : "without", population);
}

Measurements measure_clearing_grid(const Scenario& /*scenario*/, const ScorecardOptions& options) {
    return measure_means(options, kClearingGrid, kCoordinationColumns,
                         [](const Scenario& scenario, const std::string& population) {
                             return runs_on_grid(scenario.rules.clearing == "cooperative",
                                                 static_cast<int>(std::lround(scenario.signal.green_s)), population);
                         });
}

Measurements measure_four_lanes(const Scenario& /*scenario*/, const ScorecardOptions& options) {
    return measure_means(options, kFourLanes, kCoordinationColumns,
                         [](const Scenario& scenario, const std::string& population) {
                             return runs_in_berlin(scenario.rules.clearing == "cooperative", population);
                         });
}

using MaybeAnswer = std::optional<Answer>;
using MaybeNumber = std::optional<double>;

// Returns the gain in throughput over CTG-Ref on the same roads with the same measures.
template <bool kClearing, int kGreen_s>
MaybeAnswer grid_gain(const Target& /*target*/, const Measurements& m) {
    return percent_answer(mean_of_column(m, "throughput_veh_h", runs_on_grid(kClearing, kGreen_s, "CDG")),
                          mean_of_column(m, "throughput_veh_h", runs_on_grid(kClearing, kGreen_s, "CTG-Ref")), 100.0);
}

MaybeAnswer cost_without_blocking(const Target& /*target*/, const Measurements& m) {
    return percent_answer(mean_of_column(m, "throughput_veh_h", runs_on_grid(true, 10, "CDG")),
                          mean_of_column(m, "throughput_veh_h", runs_on_grid(false, 10, "CDG")), 100.0);
}

// Returns the sum of a column over the runs of CDG with clearing.
MaybeAnswer sum_with_clearing(const Measurements& m, const char* column) {
    double sum = 0.0;
    for (const int green_s : {10, 15, 20}) {
        const MaybeNumber value = mean_of_column(m, column, runs_on_grid(true, green_s, "CDG"));
        if (!value) return std::nullopt;
        sum += *value;
    }
    return number_answer(sum);
}
MaybeAnswer gridlocks_with_clearing(const Target& /*target*/, const Measurements& m) {
    return sum_with_clearing(m, "gridlocks");
}
MaybeAnswer teleported_with_clearing(const Target& /*target*/, const Measurements& m) {
    return sum_with_clearing(m, "teleported");
}

// Returns the delay by vehicles that stop in conflict areas, by full exit lanes of turning vehicles, and by gridlocks.
MaybeNumber blocking_delay_h(const Measurements& m, const std::string& runs) {
    double sum_h = 0.0;
    for (const char* const column : {"delay_junction_blocking_h", "delay_turn_blocking_h", "delay_gridlock_h"}) {
        const MaybeNumber value = mean_of_column(m, column, runs);
        if (!value) return std::nullopt;
        sum_h += *value;
    }
    return sum_h;
}
template <int kGreen_s>
MaybeAnswer blocking_share(const Target& /*target*/, const Measurements& m) {
    return percent_answer(blocking_delay_h(m, runs_on_grid(true, kGreen_s, "CDG")),
                          blocking_delay_h(m, runs_on_grid(false, kGreen_s, "CDG")), 0.0);
}

// Returns the delay of vehicles that clearing holds at their stop lines, compared with the blocking delay without
// clearing.
template <int kGreen_s>
MaybeAnswer refusal_share(const Target& /*target*/, const Measurements& m) {
    return percent_answer(mean_of_column(m, "delay_refusal_h", runs_on_grid(true, kGreen_s, "CDG")),
                          blocking_delay_h(m, runs_on_grid(false, kGreen_s, "CDG")), 0.0);
}

MaybeAnswer berlin_gain(const Measurements& m, bool coordination, const char* population) {
    return percent_answer(mean_of_column(m, "throughput_veh_h", runs_in_berlin(coordination, population)),
                          mean_of_column(m, "throughput_veh_h", runs_in_berlin(coordination, "CTG-Ref")), 100.0);
}
MaybeAnswer cdg_alone(const Target& /*target*/, const Measurements& m) { return berlin_gain(m, false, "CDG"); }
MaybeAnswer cdg_coordinated(const Target& /*target*/, const Measurements& m) { return berlin_gain(m, true, "CDG"); }
MaybeAnswer switch_coordinated(const Target& /*target*/, const Measurements& m) {
    return berlin_gain(m, true, "SWITCH-1");
}
MaybeAnswer wrong_lane_share(const Target& /*target*/, const Measurements& m) {
    return percent_answer(mean_of_column(m, "delay_wrong_lane_h", runs_in_berlin(true, "CDG")),
                          mean_of_column(m, "delay_wrong_lane_h", runs_in_berlin(false, "CDG")), 0.0);
}

}  // namespace

std::span<const Experiment> coordination_experiments() {
    static const std::array kExperiments{Experiment{kClearingGrid, "coordination_grid", false, measure_clearing_grid},
                                         Experiment{kFourLanes, "berlin", false, measure_four_lanes}};
    return kExperiments;
}

std::span<const RowJudge> coordination_rows() {
    static const std::array kRows{RowJudge{"K01", kClearingGrid, grid_gain<false, 15>},
                                  RowJudge{"K02", kClearingGrid, grid_gain<true, 15>},
                                  RowJudge{"K03", kClearingGrid, grid_gain<false, 20>},
                                  RowJudge{"K04", kClearingGrid, grid_gain<true, 20>},
                                  RowJudge{"K05", kClearingGrid, cost_without_blocking},
                                  RowJudge{"K06", kClearingGrid, gridlocks_with_clearing},
                                  RowJudge{"K07", kClearingGrid, teleported_with_clearing},
                                  RowJudge{"K08", kClearingGrid, blocking_share<15>},
                                  RowJudge{"K09", kClearingGrid, blocking_share<20>},
                                  RowJudge{"K10", kClearingGrid, refusal_share<15>},
                                  RowJudge{"K11", kClearingGrid, refusal_share<20>},
                                  RowJudge{"K12", kFourLanes, cdg_alone},
                                  RowJudge{"K13", kFourLanes, cdg_coordinated},
                                  RowJudge{"K14", kFourLanes, switch_coordinated},
                                  RowJudge{"K15", kFourLanes, wrong_lane_share}};
    return kRows;
}

}  // namespace stopline

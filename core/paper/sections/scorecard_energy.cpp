// Energy and delay in scenarios of the paper (rows E01 to E13 of data/paper/own_rows.csv). The paper does not measure
// them. The values come from two sweeps in full dynamics: the reference intersection and the grid. Section "energy" of
// the scorecard has no values of the paper.
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "paper/sections/scorecard_sections.h"
#include "paper/sections/sweep_means.h"

namespace stopline {

namespace {

constexpr const char* kEnergyIntersection = "energy_intersection";
constexpr const char* kEnergyGrid = "energy_grid";

constexpr const char* kFuelPerKm = "fuel_g_per_km";
constexpr const char* kFuelPerVehicle = "fuel_g_per_veh";
constexpr const char* kControlDelay = "hcm_control_delay_s";
constexpr const char* kTravelTime = "travel_time_s";
constexpr std::array kIntersectionColumns{kFuelPerKm, kFuelPerVehicle, kControlDelay};
constexpr std::array kGridColumns{kFuelPerKm, kFuelPerVehicle, kControlDelay, kTravelTime};

// The turns of the runs: share of left turns in percent.
std::string runs_with(int left_percent, const std::string& population) {
    return fmt::format("{} {}", left_percent, population);
}
std::string name_of_runs(const Scenario& scenario, const std::string& population) {
    return runs_with(static_cast<int>(std::lround(100.0 * scenario.demand.left_share)), population);
}

Measurements measure_intersection(const Scenario& /*scenario*/, const ScorecardOptions& options) {
    return measure_means(options, kEnergyIntersection, kIntersectionColumns, name_of_runs);
}
Measurements measure_grid(const Scenario& /*scenario*/, const ScorecardOptions& options) {
    return measure_means(options, kEnergyGrid, kGridColumns, name_of_runs);
}

using EnergyAnswer = std::optional<Answer>;

// Returns a value of CTG-Ref or CDG without turns.
template <const char* const* kColumn, bool kIsCdg>
EnergyAnswer value_without_turns(const Target& /*target*/, const Measurements& m) {
    const std::optional<double> value = mean_of_column(m, *kColumn, runs_with(0, kIsCdg ? "CDG" : "CTG-Ref"));
    return value ? number_answer(*value) : EnergyAnswer();
}

// Returns the change from CTG-Ref to CDG.
template <const char* const* kColumn, int kLeftPercent>
EnergyAnswer change(const Target& /*target*/, const Measurements& m) {
    return percent_answer(mean_of_column(m, *kColumn, runs_with(kLeftPercent, "CDG")),
                          mean_of_column(m, *kColumn, runs_with(kLeftPercent, "CTG-Ref")), 100.0);
}

constexpr int kLeftPercent = 15;  // at the intersection

}  // namespace

std::span<const Experiment> energy_experiments() {
    static const std::array kExperiments{Experiment{kEnergyIntersection, "intersection", false, measure_intersection},
                                         Experiment{kEnergyGrid, "grid", false, measure_grid}};
    return kExperiments;
}

std::span<const RowJudge> energy_rows() {
    static const std::array kRows{RowJudge{"E01", kEnergyIntersection, value_without_turns<&kFuelPerKm, false>},
                                  RowJudge{"E02", kEnergyIntersection, value_without_turns<&kFuelPerKm, true>},
                                  RowJudge{"E03", kEnergyIntersection, change<&kFuelPerKm, 0>},
                                  RowJudge{"E04", kEnergyIntersection, value_without_turns<&kControlDelay, false>},
                                  RowJudge{"E05", kEnergyIntersection, value_without_turns<&kControlDelay, true>},
                                  RowJudge{"E06", kEnergyIntersection, change<&kFuelPerKm, kLeftPercent>},
                                  RowJudge{"E07", kEnergyIntersection, change<&kControlDelay, kLeftPercent>},
                                  RowJudge{"E08", kEnergyGrid, value_without_turns<&kFuelPerKm, false>},
                                  RowJudge{"E09", kEnergyGrid, value_without_turns<&kFuelPerKm, true>},
                                  RowJudge{"E10", kEnergyGrid, change<&kFuelPerKm, 0>},
                                  RowJudge{"E11", kEnergyGrid, change<&kFuelPerVehicle, 0>},
                                  RowJudge{"E12", kEnergyGrid, change<&kControlDelay, 0>},
                                  RowJudge{"E13", kEnergyGrid, change<&kTravelTime, 0>}};
    return kRows;
}

}  // namespace stopline

// SWITCH-2: up to the switch speed, the desired gap is the standstill gap. Above this speed, the gap grows linearly and
// reaches the reference gap at the reference speed. In the paper, the reference gap is the gap of the policy CTG-Ref
// at the reference speed (Section III.C.3).
#include "spacing_laws/gap_policy.h"

namespace stopline {

namespace {

constexpr LawParameter kReferenceSpeedParameter{"reference_speed", "km/h", 1, 300,
                                                "speed at which the net gap is reference_gap"};
constexpr LawParameter kReferenceGapParameter{"reference_gap", "m", 0.1, 1000, "net gap at reference_speed"};
constexpr std::array kSwitchDistanceParameters{kSwitchSpeedParameter, kReferenceSpeedParameter, kReferenceGapParameter};

void switch_distance(const GapPolicy& policy, std::span<const double> speed_mps, std::span<double> gap_m,
                     std::span<double> slope_s) {
    const double switch_speed_mps = policy.values[0];
    const double reference_speed_mps = policy.values[1];
    const double reference_gap_m = policy.values[2];
    const double standstill_gap_m = policy.settings.standstill_gap_m;
    const double slope = (reference_gap_m - standstill_gap_m) / (reference_speed_mps - switch_speed_mps);
    for (std::size_t i = 0; i < speed_mps.size(); ++i) {
        const double excess_mps = speed_mps[i] > switch_speed_mps ? speed_mps[i] - switch_speed_mps : 0.0;
        gap_m[i] = standstill_gap_m + slope * excess_mps;
        slope_s[i] = excess_mps > 0.0 ? slope : 0.0;
    }
}

MesoGap switch_distance_meso(const GapPolicy& policy) {
    return {kConstantDistanceFamily, policy.settings.standstill_gap_m, 0.0, true};
}

std::vector<LawProblem> switch_distance_problems(const GapPolicySettings& s) {
    std::vector<LawProblem> problems;
    if (law_parameter(s, "reference_speed") <= law_parameter(s, "switch_speed")) {
        problems.push_back({"reference_speed", "must be greater than switch_speed"});
    }
    if (law_parameter(s, "reference_gap") < s.standstill_gap_m) {
        problems.push_back({"reference_gap", "must be at least standstill_gap"});
    }
    return problems;
}

}  // namespace

extern const GapLaw kSwitchDistanceLaw{
    "switch_distance",         "standstill gap, above the switch speed growing to a reference gap (SWITCH-2)",
    kSwitchDistanceParameters, switch_distance,
    switch_distance_meso,      switch_distance_problems};

}  // namespace stopline

// Human drivers: standstill gap plus time gap times speed. This is the desired gap of the intelligent driver model
// (driver/idm.h) behind a leader with the same speed. driver/human.h computes the acceleration.
#include "spacing_laws/gap_policy.h"

namespace stopline {

namespace {

constexpr std::array kHumanParameters{kTimeGapParameter};

void human_gap(const GapPolicy& policy, std::span<const double> speed_mps, std::span<double> gap_m,
               std::span<double> slope_s) {
    const double time_gap_s = policy.values[0];
    for (std::size_t i = 0; i < speed_mps.size(); ++i) {
        gap_m[i] = policy.settings.standstill_gap_m + time_gap_s * speed_mps[i];
        slope_s[i] = time_gap_s;
    }
}

MesoGap human_meso(const GapPolicy& policy) {
    return {kHumanFamily, policy.settings.standstill_gap_m, policy.values[0], false};
}

}  // namespace

extern const GapLaw kHumanLaw{
    "human",          "human drivers: standstill gap plus time gap x speed, with reaction time",
    kHumanParameters, human_gap,
    human_meso,       nullptr,
    nullptr,          true};

}  // namespace stopline

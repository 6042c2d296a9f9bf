// CDG, constant distance gap: the standstill gap at every speed (Section III.C.1 of the paper).
#include "spacing_laws/gap_policy.h"

namespace stopline {

namespace {

void constant_distance(const GapPolicy& policy, std::span<const double> speed_mps, std::span<double> gap_m,
                       std::span<double> slope_s) {
    for (std::size_t i = 0; i < speed_mps.size(); ++i) {
        gap_m[i] = policy.settings.standstill_gap_m;
        slope_s[i] = 0.0;
    }
}

MesoGap constant_distance_meso(const GapPolicy& policy) {
    return {kConstantDistanceFamily, policy.settings.standstill_gap_m, 0.0, false};
}

}  // namespace

extern const GapLaw kConstantDistanceLaw{
    "constant_distance", "the standstill gap at every speed (CDG)", {}, constant_distance, constant_distance_meso};

}  // namespace stopline

// CDG, constant distance gap: the standstill gap at every speed (Section III.C.1 of the paper).
#include "spacing_laws/gap_policy.h"

namespace stopline {

namespace {

void evaluate(const GapPolicySettings& s, std::span<const double> speed_mps, std::span<double> gap_m,
              std::span<double> slope_s) {
    for (std::size_t i = 0; i < speed_mps.size(); ++i) {
        gap_m[i] = s.standstill_gap_m;
        slope_s[i] = 0.0;
    }
}

}  // namespace

extern const GapLaw kConstantDistanceLaw{"constant_distance", "the standstill gap at every speed (CDG)", evaluate};

}  // namespace stopline

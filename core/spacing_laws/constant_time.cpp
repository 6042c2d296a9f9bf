// CTG, constant time gap: standstill gap plus time gap times speed, d = r + h v (Sections III.C.2 and III.D.1 of the
// paper).
#include "spacing_laws/gap_policy.h"

namespace stopline {

namespace {

void evaluate(const GapPolicySettings& s, std::span<const double> speed_mps, std::span<double> gap_m,
              std::span<double> slope_s) {
    for (std::size_t i = 0; i < speed_mps.size(); ++i) {
        gap_m[i] = s.standstill_gap_m + s.time_gap_s * speed_mps[i];
        slope_s[i] = s.time_gap_s;
    }
}

}  // namespace

extern const GapLaw kConstantTimeLaw{"constant_time", "standstill gap plus time gap x speed (CTG)", evaluate};

}  // namespace stopline

// CTG, constant time gap: standstill gap plus time gap times speed, d = r + h v (Sections III.C.2 and III.D.1 of the
// paper).
#include "spacing_laws/gap_policy.h"

namespace stopline {

namespace {

constexpr std::array kConstantTimeParameters{kTimeGapParameter};

void constant_time(const GapPolicy& policy, std::span<const double> speed_mps, std::span<double> gap_m,
                   std::span<double> slope_s) {
    const double time_gap_s = policy.values[0];
    for (std::size_t i = 0; i < speed_mps.size(); ++i) {
        gap_m[i] = policy.settings.standstill_gap_m + time_gap_s * speed_mps[i];
        slope_s[i] = time_gap_s;
    }
}

MesoGap constant_time_meso(const GapPolicy& policy) {
    return {kTimeGapFamily, policy.settings.standstill_gap_m, policy.values[0], false};
}

}  // namespace

extern const GapLaw kConstantTimeLaw{"constant_time", "standstill gap plus time gap x speed (CTG)",
                                     kConstantTimeParameters, constant_time, constant_time_meso};

}  // namespace stopline

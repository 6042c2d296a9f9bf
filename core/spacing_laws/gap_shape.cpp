#include "spacing_laws/gap_shape.h"

#include <cmath>

#include <fmt/format.h>

namespace stopline {

namespace {

constexpr double kMaxSlope_s = 20.0;
constexpr double kRounding_m = 1e-6;

std::string speed_text(std::size_t node) {
    return fmt::format("{:.4g} km/h", 3.6 * static_cast<double>(node) / GapTable::kNodesPerMps);
}

}  // namespace

std::string gap_shape_problem(const GapTable& table, double standstill_gap_m) {
    const std::vector<double>& gap_m = table.gap_m;
    for (std::size_t k = 0; k < gap_m.size(); ++k) {
        if (!std::isfinite(gap_m[k])) return fmt::format("the gap at {} is not a finite number", speed_text(k));
    }
    if (std::abs(gap_m.front() - standstill_gap_m) > kRounding_m) {
        return fmt::format("the gap at rest is {:.4g} m, but standstill_gap is {:.4g} m", gap_m.front(),
                           standstill_gap_m);
    }
    for (std::size_t k = 1; k < gap_m.size(); ++k) {
        const double growth_m = gap_m[k] - gap_m[k - 1];
        if (growth_m < -kRounding_m) {
            return fmt::format("the gap falls near {}: it may not fall with the speed", speed_text(k));
        }
        if (growth_m * GapTable::kNodesPerMps > kMaxSlope_s) {
            return fmt::format(
                "the gap grows by {:.3g} m near {}: it may not jump, and grows by at most {:g} m per m/s", growth_m,
                speed_text(k), kMaxSlope_s);
        }
    }
    return "";
}

void evaluate_gap_table(const GapPolicy& policy, std::span<const double> speed_mps, std::span<double> gap_m,
                        std::span<double> slope_s) {
    policy.table.evaluate(speed_mps, gap_m, slope_s);
}

MesoGap shaped_meso_gap(const GapPolicy& policy) {
    constexpr double kReference_mps = 50.0 / 3.6;
    const double standstill_m = policy.settings.standstill_gap_m;
    const double time_gap_s = (equilibrium_gap_m(policy, kReference_mps) - standstill_m) / kReference_mps;
    return {"", standstill_m, time_gap_s, true};
}

}  // namespace stopline

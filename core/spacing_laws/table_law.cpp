// The policy gives the gap of this law as a table: the net gap at some speeds. At rest, the gap is the standstill gap.
// Between these points it is linear. Above the last speed, it continues with the last slope.
#include <fmt/format.h>

#include "spacing_laws/gap_policy.h"
#include "spacing_laws/gap_shape.h"

namespace stopline {

namespace {

GapTable points_table(const GapPolicySettings& settings) {
    std::vector<double> speed_mps{0.0};
    std::vector<double> gap_m{settings.standstill_gap_m};
    speed_mps.insert(speed_mps.end(), settings.gap_speed_mps.begin(), settings.gap_speed_mps.end());
    gap_m.insert(gap_m.end(), settings.gap_at_speed_m.begin(), settings.gap_at_speed_m.end());
    GapTable table;
    table.gap_m.resize(GapTable::kNodes);
    std::size_t after = 1;  // index of the first point above the speed v, or of the last point
    for (std::size_t k = 0; k < GapTable::kNodes; ++k) {
        const double v = static_cast<double>(k) / GapTable::kNodesPerMps;
        while (after + 1 < speed_mps.size() && speed_mps[after] <= v) ++after;
        const double slope_s = (gap_m[after] - gap_m[after - 1]) / (speed_mps[after] - speed_mps[after - 1]);
        table.gap_m[k] = gap_m[after - 1] + slope_s * (v - speed_mps[after - 1]);
    }
    return table;
}

std::vector<LawProblem> points_problems(const GapPolicySettings& settings) {
    const std::string problem = gap_shape_problem(points_table(settings), settings.standstill_gap_m);
    if (problem.empty()) return {};
    return {{"gaps", problem}};
}

}  // namespace

extern const GapLaw kTableLaw{"table",
                              "the net gap at some speeds, in the field gaps; linear between them",
                              {},
                              evaluate_gap_table,
                              shaped_meso_gap,
                              points_problems,
                              points_table};

}  // namespace stopline

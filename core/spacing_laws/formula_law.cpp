// The policy gives the gap of this law as a formula, such as "s0 + 0.4 s * v + 0.01 s2/m * v^2" (formula.h).
#include <cmath>

#include <fmt/format.h>

#include "spacing_laws/formula.h"
#include "spacing_laws/gap_policy.h"
#include "spacing_laws/gap_shape.h"

namespace stopline {

namespace {

GapTable formula_table(const GapPolicySettings& settings) {
    GapFormula::Error error;
    const GapFormula formula = GapFormula::parse(settings.gap_formula, error);
    GapTable table;
    if (!error.message.empty()) return table;
    table.gap_m.resize(GapTable::kNodes);
    for (std::size_t k = 0; k < GapTable::kNodes; ++k) {
        table.gap_m[k] = formula.gap_m(settings.standstill_gap_m, static_cast<double>(k) / GapTable::kNodesPerMps);
    }
    return table;
}

// Returns where the formula jumps between two nodes of its table; empty if it does not. Halves the interval again and
// again: at a jump, the growth of the gap does not become smaller.
std::string jump_problem(const GapTable& table, const GapPolicySettings& settings) {
    constexpr double kSmallestJump_m = 1e-3;
    constexpr int kHalvings = 30;
    GapFormula::Error error;
    const GapFormula formula = GapFormula::parse(settings.gap_formula, error);
    for (std::size_t k = 1; k < table.gap_m.size(); ++k) {
        double low_m = table.gap_m[k - 1];
        double high_m = table.gap_m[k];
        double low_mps = static_cast<double>(k - 1) / GapTable::kNodesPerMps;
        double high_mps = static_cast<double>(k) / GapTable::kNodesPerMps;
        for (int halving = 0; halving < kHalvings && high_m - low_m > kSmallestJump_m; ++halving) {
            const double middle_mps = 0.5 * (low_mps + high_mps);
            const double middle_m = formula.gap_m(settings.standstill_gap_m, middle_mps);
            const bool is_upper_half = high_m - middle_m > middle_m - low_m;
            (is_upper_half ? low_m : high_m) = middle_m;
            (is_upper_half ? low_mps : high_mps) = middle_mps;
        }
        if (high_m - low_m > kSmallestJump_m) {
            return fmt::format("the gap jumps by {:.3g} m at {:.4g} km/h: it may not jump", high_m - low_m,
                               3.6 * high_mps);
        }
    }
    return "";
}

std::vector<LawProblem> formula_problems(const GapPolicySettings& settings) {
    GapFormula::Error error;
    GapFormula::parse(settings.gap_formula, error);
    if (!error.message.empty()) {
        return {{"gap",
                 fmt::format("value '{}', character {}: {}", settings.gap_formula, error.position + 1, error.message)}};
    }
    const GapTable table = formula_table(settings);
    std::string problem = gap_shape_problem(table, settings.standstill_gap_m);
    if (problem.empty()) problem = jump_problem(table, settings);
    if (problem.empty()) return {};
    return {{"gap", fmt::format("value '{}': {}", settings.gap_formula, problem)}};
}

}  // namespace

extern const GapLaw kFormulaLaw{
    "formula",    "a formula of the speed, in the field gap", {}, evaluate_gap_table, shaped_meso_gap, formula_problems,
    formula_table};

}  // namespace stopline

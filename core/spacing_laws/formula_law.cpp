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

std::vector<LawProblem> formula_problems(const GapPolicySettings& settings) {
    GapFormula::Error error;
    GapFormula::parse(settings.gap_formula, error);
    if (!error.message.empty()) {
        return {{"gap",
                 fmt::format("value '{}', character {}: {}", settings.gap_formula, error.position + 1, error.message)}};
    }
    const std::string problem = gap_shape_problem(formula_table(settings), settings.standstill_gap_m);
    if (problem.empty()) return {};
    return {{"gap", fmt::format("value '{}': {}", settings.gap_formula, problem)}};
}

}  // namespace

extern const GapLaw kFormulaLaw{"formula",
                                "a formula of the speed, in the field gap",
                                {},
                                evaluate_gap_table,
                                shaped_meso_gap,
                                formula_problems,
                                formula_table,
                                true};

}  // namespace stopline

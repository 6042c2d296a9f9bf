#include "spacing_laws/gap_policy.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/containers/index.h"
#include "base/input_error.h"

namespace stopline {

namespace {

std::vector<LawParameter> all_parameters() {
    std::vector<LawParameter> all;
    for (const GapLaw* law : gap_laws()) {
        for (const LawParameter& parameter : law->parameters) {
            const auto has_name = [&](const LawParameter& one) { return std::string_view(one.name) == parameter.name; };
            if (std::none_of(all.begin(), all.end(), has_name)) all.push_back(parameter);
        }
    }
    if (all.size() > kMaxLawParameters) throw std::logic_error("more law parameters than kMaxLawParameters");
    return all;
}

std::size_t index_of(std::string_view name) {
    const std::vector<LawParameter>& all = law_parameters();
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (name == all[k].name) return k;
    }
    throw std::logic_error(fmt::format("no law has the parameter '{}'", name));
}

}  // namespace

const std::vector<LawParameter>& law_parameters() {
    static const std::vector<LawParameter> kAll = all_parameters();
    return kAll;
}

double law_parameter(const GapPolicySettings& settings, std::string_view name) {
    return settings.parameters[index_of(name)];
}

void set_law_parameter(GapPolicySettings& settings, std::string_view name, double value) {
    settings.parameters[index_of(name)] = value;
}

void GapTable::evaluate(std::span<const double> speed_mps, std::span<double> gap, std::span<double> slope_s) const {
    for (std::size_t i = 0; i < speed_mps.size(); ++i) {
        const double at_node = std::max(speed_mps[i], 0.0) * kNodesPerMps;
        const std::size_t k = std::min(static_cast<std::size_t>(std::min(at_node, 1e9)), kNodes - 2);
        const double step_m = gap_m[k + 1] - gap_m[k];
        gap[i] = gap_m[k] + (at_node - static_cast<double>(k)) * step_m;
        slope_s[i] = step_m * kNodesPerMps;
    }
}

void GapPolicy::evaluate(std::span<const double> speed_mps, std::span<double> gap_m, std::span<double> slope_s) const {
    law->evaluate(*this, speed_mps, gap_m, slope_s);
}

namespace {

// Returns `gap` for the car-following model `family` that the policy names.
MesoGap with_family(const std::string& family, MesoGap gap) {
    if (family == kFamilyByLaw) return gap;
    // The constant-distance model keeps no time gap. The extra gap then contains the whole growth of the gap with
    // speed.
    if (family == kConstantDistanceFamily && gap.time_gap_s != 0.0) {
        gap.time_gap_s = 0.0;
        gap.has_extra_gap = true;
    }
    gap.family = family;
    return gap;
}

}  // namespace

GapPolicy make_gap_policy(const GapPolicySettings& settings) {
    GapPolicy policy{settings, &find_gap_law(settings.law), {}, {}, {}};
    for (std::size_t k = 0; k < policy.law->parameters.size(); ++k) {
        policy.values[k] = law_parameter(settings, policy.law->parameters[k].name);
    }
    if (policy.law->tabulate != nullptr) policy.table = policy.law->tabulate(settings);
    policy.meso = with_family(settings.mesoscale, policy.law->meso_gap(policy));
    return policy;
}

double equilibrium_gap_m(const GapPolicy& policy, double speed_mps) {
    double gap_m = 0.0;
    double slope_s = 0.0;
    policy.evaluate({&speed_mps, 1}, {&gap_m, 1}, {&slope_s, 1});
    return gap_m;
}

double equilibrium_gap_m(const GapPolicySettings& settings, double speed_mps) {
    return equilibrium_gap_m(make_gap_policy(settings), speed_mps);
}

}  // namespace stopline

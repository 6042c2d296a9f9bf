// Fields of spacing policies and populations.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenario/schema/field_rows.h"
#include "scenario/schema/fields.h"
#include "sim/mesoscale/following_families.h"
#include "spacing_laws/gap_policy.h"

namespace stopline {
namespace {

// Returns the names of the laws for which a condition holds.
template <class Condition>
std::vector<std::string> laws_with(const Condition& holds) {
    std::vector<std::string> names;
    for (const GapLaw* law : gap_laws()) {
        if (holds(*law)) names.emplace_back(law->name);
    }
    return names;
}

// Adds a row for each parameter of the laws (law_parameters()).
template <std::size_t... Index>
void add_law_parameters(std::index_sequence<Index...> /*indices*/, std::vector<Row<GapPolicySettings>>& rows) {
    const auto add = [&]<std::size_t k>() {
        if (k >= law_parameters().size()) return;
        const LawParameter& parameter = law_parameters()[k];
        const auto has_parameter = [&](const GapLaw& law) {
            return std::any_of(law.parameters.begin(), law.parameters.end(),
                               [&](const LawParameter& one) { return std::string_view(one.name) == parameter.name; });
        };
        rows.push_back(number_at<&GapPolicySettings::parameters, k>(parameter.name, parameter.unit,
                                                                    {parameter.min, parameter.max}, parameter.meaning)
                           .required()
                           .only_if("law", laws_with(has_parameter)));
    };
    (add.template operator()<Index>(), ...);
}

std::vector<std::string> mesoscale_names() {
    std::vector<std::string> names{kFamilyByLaw};
    for (const FollowingFamily& family : following_families()) names.emplace_back(family.text.name);
    return names;
}

std::string mesoscale_meaning() {
    std::string meaning =
        "car-following model of the mesoscale mode for this policy; by_law: the model that the law implies (the laws "
        "formula and table imply none)";
    for (const FollowingFamily& family : following_families()) {
        meaning += std::string("; ") + family.text.name + ": " + family.text.meaning;
    }
    return meaning;
}

std::vector<Row<GapPolicySettings>> gap_policy_rows() {
    using S = GapPolicySettings;
    std::vector<Row<S>> rows{
        text<&S::name>("name", TextField::Rule::name, "name of the policy").required(),
        choice<&S::law>("law", gap_law_names(), "spacing law: how the gap depends on the speed").required(),
        number<&S::standstill_gap_m>("standstill_gap", "m", {0.1, 100}, "net gap at standstill").required(),
    };
    add_law_parameters(std::make_index_sequence<kMaxLawParameters>(), rows);
    rows.push_back(text<&S::gap_formula>("gap", TextField::Rule::title,
                                         "net gap as a formula of the speed v and the standstill gap s0, such as "
                                         "\"s0 + 0.4 s * v + 0.01 s2/m * v^2\"; functions: min, max, sqrt, "
                                         "if(v < 30 km/h, ..., ...)")
                       .required()
                       .only_if("law", {"formula"}));
    rows.push_back(curve<&S::gap_speed_mps, &S::gap_at_speed_m>("gaps", {"km/h", {0.1, 300}}, {"m", {0.1, 1000}},
                                                                {1, 200},
                                                                "net gap over speed, without the gap at standstill; "
                                                                "above the last speed, the last slope goes on")
                       .required()
                       .only_if("law", {"table"}));
    rows.push_back(choice<&S::mesoscale>("mesoscale", mesoscale_names(), mesoscale_meaning()));
    return rows;
}

const Table& component_table() {
    using S = PopulationSettings::Component;
    static const Table table =
        make_table<S>("a part of a population",
                      {
                          text<&S::policy>("policy", TextField::Rule::name, "name of the spacing policy").required(),
                          number<&S::share>("share", "%", {0, 100}, "share of the vehicles").required(),
                          optional_section<&S::vehicle>("vehicle", vehicle_table,
                                                        "vehicle and powertrain of this part, with the fields of "
                                                        "`vehicle`; default: the vehicle of the scenario",
                                                        "vehicles"),
                          optional_section<&S::driver>("driver", driver_table,
                                                       "driver of this part, with the fields of `driver`; default: the "
                                                       "driver of the scenario",
                                                       "drivers"),
                      });
    return table;
}

void check_population(const PopulationSettings& population, Checker& check) {
    double sum = 0.0;
    for (const PopulationSettings::Component& component : population.components) sum += component.share;
    if (std::abs(sum - 1.0) > 1e-9) {
        check.error("components", "the shares sum to " + short_text(sum, unit("%")) + ", not to 100 %");
    }
}

// Returns a copy of the scalar with another text and the same position.
SourceNode with_text(const SourceNode& scalar, std::string text) {
    SourceNode node = scalar;
    node.text = std::move(text);
    return node;
}

// Makes the population in which all vehicles follow one policy. Expands `CDG` to
// {name: CDG, components: [{policy: CDG, share: 100 %}]}.
SourceNode population_of_one_policy(const SourceNode& policy) {
    SourceNode component;
    component.kind = SourceNode::Kind::map;
    component.place = policy.place;
    component.add({"policy", policy.place}, policy);
    component.add({"share", policy.place}, with_text(policy, "100 %"));
    SourceNode components;
    components.kind = SourceNode::Kind::list;
    components.place = policy.place;
    components.items.push_back(std::move(component));
    SourceNode population;
    population.kind = SourceNode::Kind::map;
    population.place = policy.place;
    population.add({"name", policy.place}, policy);
    population.add({"components", policy.place}, std::move(components));
    return population;
}

}  // namespace

const Table& gap_policy_table() {
    static const Table table =
        make_table<GapPolicySettings>("a spacing policy: the net gap as a function of speed", gap_policy_rows(),
                                      [](const GapPolicySettings& s, Checker& check) {
                                          const GapLaw& law = find_gap_law(s.law);
                                          if (law.problems == nullptr) return;
                                          for (const LawProblem& problem : law.problems(s))
                                              check.error(problem.field, problem.message);
                                      });
    return table;
}

const Table& policy_file_table() {
    static const Table table = make_table<PolicyFile>(
        "named spacing policies",
        {list<&PolicyFile::policies>("policies", gap_policy_table, {1, 1000}, "spacing policies").required()});
    return table;
}

const Table& population_table() {
    using S = PopulationSettings;
    static const Table table = make_table<S>(
        "a mix of vehicles by spacing policy, with the share of each policy; an entry can be just the name of a "
        "policy, which all vehicles then follow",
        {
            text<&S::name>("name", TextField::Rule::name, "name of the population").required(),
            enumeration<&S::pattern>("pattern", {"alternating", "random", "balanced"},
                                     "order of the policies; balanced: the shares hold in every 20 vehicles of a lane"),
            list<&S::components>("components", component_table, {1, 100}, "policies with their shares").required(),
        },
        check_population, population_of_one_policy);
    return table;
}

}  // namespace stopline

// Fields of a scenario and of its measurements, and the checks that compare several parts of a scenario.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "scenario/driving_checks.h"
#include "scenario/fleets.h"
#include "scenario/kinds/kind_parts.h"
#include "scenario/network_checks.h"
#include "scenario/schema/field_rows.h"
#include "scenario/schema/fields.h"

namespace stopline {
namespace {

bool is_whole(double number) { return std::abs(number - std::round(number)) <= 1e-6; }

// Checks that a second is a whole number of steps, and measure.interval a whole number of seconds. In networks of
// several intersections, vehicles are counted once per second.
void check_seconds(const Scenario& scenario, Checker& check) {
    if (!is_whole(1.0 / scenario.tick_s())) {
        check.error(scenario.is_meso() ? "meso.step" : "step",
                    "vehicles are counted every second, but 1 s is not a whole number of steps of " +
                        short_text(scenario.tick_s(), unit("ms")));
    }
    if (!is_whole(scenario.measure.interval_s)) {
        check.error("measure.interval", "value " + short_text(scenario.measure.interval_s, unit("s")) +
                                            " is not a whole number of seconds; vehicles are counted every second");
    }
}

template <class T>
std::vector<std::string> names_of(const std::vector<T>& named) {
    std::vector<std::string> names;
    names.reserve(named.size());
    for (const T& item : named) names.push_back(item.name);
    return names;
}

void check_unique(const std::vector<std::string>& names, const std::string& list, Checker& check) {
    std::set<std::string> seen;
    for (const std::string& name : names) {
        if (!seen.insert(name).second) {
            check.error(list + "[" + name + "].name", "the name '" + name + "' appears twice");
        }
    }
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

void check_names(const Scenario& scenario, Checker& check) {
    const std::vector<std::string> policies = names_of(scenario.policies);
    const std::vector<std::string> populations = names_of(scenario.populations);
    check_unique(policies, "policies", check);
    check_unique(populations, "populations", check);
    if (contains(populations, kNoBaseline)) {
        check.error(fmt::format("populations[{}].name", kNoBaseline),
                    fmt::format("the name '{}' is reserved: as measure.baseline it means no comparison; give another "
                                "name",
                                kNoBaseline));
    }
    for (const PopulationSettings& population : scenario.populations) {
        for (std::size_t k = 0; k < population.components.size(); ++k) {
            const std::string field =
                "populations[" + population.name + "].components[" + std::to_string(k) + "].policy";
            const std::string& policy = population.components[k].policy;
            if (contains(policies, policy)) continue;
            check.error(field, "there is no policy '" + policy + "'" + known_names_hint(policy, policies));
        }
    }
    const std::string& baseline = scenario.measure.baseline;
    if (baseline.empty() || baseline == kNoBaseline || contains(populations, baseline)) return;
    check.error("measure.baseline",
                fmt::format("there is no population '{}'{}; give one of these, or {} for no comparison", baseline,
                            known_names_hint(baseline, populations), kNoBaseline));
}

void check_times(const Scenario& scenario, Checker& check) {
    double shortest_s = std::numeric_limits<double>::infinity();
    for (const PopulationSettings::Component* component : all_components(scenario)) {
        shortest_s = std::min(shortest_s, driver_of(scenario, *component).cacc.v2v_delay_s);
    }
    if (!scenario.is_meso() && shortest_s < scenario.step_s) {
        check.error(check.given("step") ? "step" : "driver.cacc.v2v_delay",
                    "a message cannot arrive before the next step: step, " + short_text(scenario.step_s, unit("ms")) +
                        ", must be at most driver.cacc.v2v_delay, " + short_text(shortest_s, unit("ms")));
    }
    if (!network_kind(scenario.network).ends_after_cycles && scenario.duration_s < 1.0) {
        check.error("duration", "must be at least 1 s");
    }
}

void check_time_space(const Scenario& scenario, Checker& check) {
    const MeasureSettings& measure = scenario.measure;
    if (measure.time_space_s > 0.0 && network_kind(scenario.network).diagram_street == nullptr) {
        return check.error("measure.time_space", "is for grids and streets only");
    }
    if (measure.time_space_side == "west" || measure.time_space_s > 0.0) return;
    check.error("measure.time_space_side",
                "value " + measure.time_space_side + " has no effect without measure.time_space");
}

// Reports each field of the section `measure` that the scenario sets, but that has no effect on this kind of network. A
// field with its default value is not reported, because canonical_text() writes all fields.
void refuse_unused_measures(const Scenario& scenario, Checker& check) {
    const MeasureSettings& measure = scenario.measure;
    const MeasureSettings defaults;
    const NetworkKind& kind = network_kind(scenario.network);
    const auto refuse = [&](const char* field, bool is_set, bool has_effect, const char* networks) {
        if (!is_set || has_effect) return;
        check.error(std::string("measure.") + field, fmt::format("is for {}", networks));
    };
    constexpr const char* kLight = "a single light only (network.kind: approach)";
    const bool is_light = kind.run == kRunAsSingleLight;
    refuse("green", measure.green_s != defaults.green_s, is_light, kLight);
    refuse("string_stability", measure.string_stability != defaults.string_stability, is_light, kLight);
    constexpr const char* kIntersection = "a single intersection only (network.kind: intersection)";
    const bool is_intersection = kind.run == kRunAsIntersection;
    refuse("warmup_cycles", measure.warmup_cycles != defaults.warmup_cycles, is_intersection, kIntersection);
    refuse("cycles", measure.cycles != defaults.cycles, is_intersection, kIntersection);
    refuse("zones", measure.zone_radius_m != defaults.zone_radius_m, is_intersection, kIntersection);
    constexpr const char* kNetwork = "networks of several intersections only (network.kind: grid, streets, sumo)";
    refuse("interval", measure.interval_s != defaults.interval_s, kind.has_measured_area, kNetwork);
    refuse("window", measure.window_s != defaults.window_s, kind.has_measured_area, kNetwork);
    refuse("area_margin", measure.area_margin_m != defaults.area_margin_m, kind.has_measured_area && !kind.has_trips,
           "grids and streets only: the other networks have no measured area, or measure the whole network");
    refuse("loops", !measure.loops.empty(), !kind.has_trips,
           "networks without SUMO files only: give an induction loop (inductionLoop) in a file of network.additional");
    refuse("starvation", measure.starvation_s != defaults.starvation_s, kind.has_intersections,
           "networks with intersections only");
}

// Checks that all vehicles have data for their energy use.
void check_energy(const Scenario& scenario, Checker& check) {
    if (scenario.measure.energy == "off") return;
    std::set<std::string> names;
    for (const PopulationSettings::Component* component : all_components(scenario)) {
        const PowertrainSettings& vehicle = vehicle_of(scenario, *component);
        if (vehicle.energy || !names.insert(vehicle.name).second) continue;
        check.error("measure.energy", "vehicle '" + vehicle.name +
                                          "' has no section energy: there are no data for its energy use; add the "
                                          "section to its file, or remove measure.energy");
    }
}

void check_controller(const Scenario& scenario, Checker& check) {
    const int groups = network_kind(scenario.network).signal_groups;
    const SignalController& controller = find_signal_controller(scenario.signal.controller);
    if (groups == 0 || controller.problems == nullptr) return;
    for (const SignalProblem& problem : controller.problems(scenario.signal, groups)) {
        check.error("signal." + problem.field, problem.message);
    }
}

// Returns null if the signals have programmes of their own and follow them. The section is then not written.
const void* read_signal(const void* settings) {
    const auto& scenario = *static_cast<const Scenario*>(settings);
    const bool has_effect = network_kind(scenario.network).signal_groups > 0 ||
                            !find_signal_controller(scenario.signal.controller).follows_programme;
    return has_effect ? &scenario.signal : nullptr;
}

Row<Scenario> signal_section() {
    const SectionField section{[](void* settings) -> void* { return &static_cast<Scenario*>(settings)->signal; },
                               read_signal, signal_table, ""};
    return Row<Scenario>{{"signal",
                          "signal of each intersection; streets have signal programmes of their own, of which the "
                          "section chooses the controller and its detectors; SUMO networks have signals of their own",
                          section}}
        .only_if("network.kind",
                 kinds_with([](const NetworkKind& kind) { return kind.signal_groups > 0 || kind.chooses_controller; }));
}

void check_scenario(const Scenario& scenario, Checker& check) {
    const NetworkKind& kind = network_kind(scenario.network);
    kind.check(scenario, check);
    check_whole_steps(scenario, "duration", scenario.duration_s, check);
    if (kind.has_measured_area) check_seconds(scenario, check);
    check_controller(scenario, check);
    check_times(scenario, check);
    check_names(scenario, check);
    check_fleets(scenario, check);
    check_gaps(scenario, check);
    check_entries(scenario, check);
    check_stop_detector(scenario, check);
    check_approaches(scenario, check);
    check_measured_area(scenario, check);
    check_loops(scenario, check);
    check_unique(names_of(scenario.measure.loops), "measure.loops", check);
    check_time_space(scenario, check);
    refuse_unused_measures(scenario, check);
    check_energy(scenario, check);
}

}  // namespace

namespace {

const Table& loop_table() {
    using S = LoopSettings;
    static const Table table = make_table<S>(
        "an induction loop, which counts vehicles for --e1",
        {
            text<&S::name>("name", TextField::Rule::name, "id of the loop in the file of --e1").required(),
            text<&S::lane>("lane", TextField::Rule::title, "name of its lane, such as west_in_0 or c0r0_west_in_0")
                .required(),
            number<&S::position_m>("position", "m", {-20'000, 20'000},
                                   "distance from the start of the lane; below 0 m: from the stop line, or from the "
                                   "end of a lane without stop line")
                .required(),
        });
    return table;
}

}  // namespace

const Table& measure_table() {
    using S = MeasureSettings;
    static const Table table = make_table<S>(
        "the measurements",
        {
            numbers<&S::green_s>(
                "green", "s", {0.1, 7200}, {0, 1000},
                "single light: times after the start of green at which the vehicles past the stop line are counted",
                true),
            text<&S::baseline>(
                "baseline", TextField::Rule::name,
                "population with which the others are compared; absent or none: no improvements are computed"),
            choice<&S::string_stability>(
                "string_stability", {"off", "on"},
                "single light: measure whether accelerations grow from vehicle to vehicle when the queue starts"),
            whole_number<&S::warmup_cycles>("warmup_cycles", {0, 1000},
                                            "single intersection: signal cycles before the measurement"),
            whole_number<&S::cycles>("cycles", {1, 100'000},
                                     "single intersection: measured signal cycles; a `duration` replaces it: the run "
                                     "is then measured from the end of the warm-up to its end"),
            numbers<&S::zone_radius_m>(
                "zones", "m", {1, 20'000}, {0, 10},
                "single intersection: radii around the centre within which travel time and density are "
                "measured; reports show the first",
                false),
            number<&S::starvation_s>(
                "starvation", "s", {0, 86'400},
                "intersections: a movement starves, and the run fails, if the first vehicle of a queue is stopped for this "
                "time, and for two cycles of its signal, although nothing blocks its way; the default is the time after "
                "which SUMO teleports; 0 s: never"),
            choice<&S::departure_delay>(
                "departure_delay", {"off", "on"},
                "report the departure delays: the times from the arrival of vehicles to their entry into the network"),
            choice<&S::energy>("energy", {"off", "on"},
                               "report fuel, CO2 and electric energy; the mesoscale mode estimates them"),
            choice<&S::surrogate_safety>(
                "surrogate_safety", {"off", "on"},
                "report comfort and surrogate safety: jerk, hard braking, time to collision, brake threat number, smallest gaps"),
            choice<&S::hcm>(
                "hcm", {"off", "on"},
                "lanes with a signal: report saturation flow, capacity, control delay, queues and level of service of each "
                "lane by the Highway Capacity Manual, in hcm.csv"),
            list<&S::loops>("loops", loop_table, {0, 1000},
                            "additional induction loops for --e1, on approach lanes and exit lanes; imported networks "
                            "define their loops in the files of network.additional"),
            number<&S::area_margin_m>("area_margin", "m", {0, 10'000},
                                      "grids and streets: distance from the outer intersections to the boundary of the "
                                      "measured area, on their approaches and exit lanes")
                .renamed_from("outside"),
            number<&S::interval_s>("interval", "s", {1, 86'400},
                                   "networks: interval of the time series, in whole seconds"),
            number<&S::window_s>(
                "window", "s", {1, 1'000'000},
                "networks: length of the measuring window at the end of the run; results are means over "
                "it")
                .renamed_from("steady"),
            number<&S::time_space_s>(
                "time_space", "s", {0, 7200},
                "grids and streets: time at the end of the run that the time-space diagram covers; 0 s: no diagram"),
            choice<&S::time_space_side>("time_space_side", {"west", "east", "south", "north"},
                                        "side from which the time-space diagram follows a street; in a grid, west and "
                                        "east: the middle row, south and north: the middle column")
                .renamed_from("time_space_from"),
        });
    return table;
}

const Table& scenario_table() {
    using S = Scenario;
    static const Table table = make_table<S>(
        "a scenario file",
        {
            text<&S::name>("name", TextField::Rule::name, "name of the scenario; default: the name of the file"),
            text<&S::title>("title", TextField::Rule::title, "heading of tables and figures"),
            choice<&S::fidelity>(
                "fidelity", {"full", "meso"},
                "vehicle model; full: controller and powertrain (full dynamics); meso: car-following models only "
                "(mesoscale mode)"),
            // A step above 0.1 s would be longer than the shortest lags of the powertrain.
            number<&S::step_s>("step", "s", {0.001, 0.1},
                               "time step of full dynamics, at most driver.cacc.v2v_delay; the mesoscale mode uses "
                               "meso.step"),
            number<&S::duration_s>(
                "duration", "s", {0, 1'000'000},
                "length of a run; 0 s: the run ends after the measured cycles, which is the default of a single intersection "
                "and allowed for no other network"),
            whole_number<&S::seed>("seed", {}, "seed of all random numbers"),
            section<&S::network>("network", network_table, "road network"),
            signal_section(),
            section<&S::demand>("demand", demand_table, "traffic that enters; SUMO networks have route files instead")
                .only_if("network.kind", kinds_with([](const NetworkKind& kind) { return !kind.has_trips; })),
            section<&S::vehicle>("vehicle", vehicle_table, "vehicle and powertrain", "vehicles")
                .fallback("petrol_eu4_72kw"),
            section<&S::driver>("driver", driver_table, "driver: controllers and behaviour", "drivers")
                .fallback("startup_kit"),
            section<&S::rules>("rules", rules_table, "rules against junction blocking and gridlock"),
            section<&S::meso>("meso", meso_table, "parameters of the mesoscale mode", "meso").fallback("table2"),
            list<&S::policies>(
                "policies", gap_policy_table, {0, 1000},
                "additional spacing policies; each replaces the policy of the same name in data/policies/paper.yaml",
                "policies/paper")
                .fallback("[]"),
            list<&S::populations>("populations", population_table, {1, 1000},
                                  "populations; the scenario is run once for each of them")
                .fallback(
                    "[CDG, CDG-6m, SWITCH-1, SWITCH-2, {name: MIX, pattern: alternating, components: [{policy: CDG, "
                    "share: 50 %}, {policy: CTG-Ref, share: 50 %}]}, CTG-Ref, CTG-HCM, CTG-HBS]"),
            section<&S::measure>("measure", measure_table, "measurements"),
        },
        check_scenario);
    return table;
}

}  // namespace stopline

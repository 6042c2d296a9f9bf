// Runs a scenario and checks the run. Used by simulations.py.
//
//     stopline_check_scenario FILE [reference] [threads]
//
// The checks:
//   - violations that the program reports: overlaps, conflicts, entries on red, lost vehicles, deadlocks
//   - motion: positions, gaps and the number of vehicles (motion_check.h)
//   - repeat: a second run, with the kernels that compute one vehicle at a time, gives the same state hash
//   - threads: the first part of the run, on two threads, gives the same state hash. Only with the word `threads`
//   - reference: the first part of the run agrees with the reference engine, if that covers the scenario. Only with the
//     word `reference`
//
// Prints one line for each population and check that fails: the check, a tab and a text. Some lines are no failures:
// `starved`, `compared`, `rounding`, and `deadlock_expected` for a deadlock at an intersection whose rules or signal
// times do not prevent it. Exit codes: 0 all checks hold, 1 some fail, 2 the scenario is refused.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/input_error.h"
#include "campaign/motion_check.h"
#include "reference/comparison.h"
#include "runs/intersection/intersection.h"
#include "runs/network/network.h"
#include "runs/run_kind.h"
#include "runs/single_light/single_light.h"
#include "scenario/build_model.h"
#include "scenario/fleets.h"
#include "scenario/kinds/network_kind.h"
#include "scenario/load_scenario.h"

namespace {

using namespace stopline;

// Prints failures.
class Results {
public:
    void fail(const std::string& check, const std::string& text) {
        fmt::print("{}\t{}\n", check, text);
        has_failed_ = true;
    }
    bool has_failed() const { return has_failed_; }

private:
    bool has_failed_ = false;
};

// The results of a run that the checks use.
struct Outcome {
    std::string population;
    Violations violations;
    std::uint64_t hash = 0;
};

template <class PopulationResults>
std::vector<Outcome> outcomes_of(const PopulationResults& results) {
    std::vector<Outcome> outcomes;
    for (const auto& result : results) outcomes.push_back({result.population, result.violations, result.state_hash});
    return outcomes;
}

void note_starvation(const std::vector<PopulationStarvations>& populations) {
    for (const PopulationStarvations& population : populations) {
        for (const Starvation& s : population.starvations)
            fmt::print("starved\tvehicle {} is stopped from {} s to {} s\n", s.vehicle, s.from_s, s.to_s);
    }
}

// Runs all populations as the programs do.
std::vector<Outcome> run_all(const Scenario& scenario, const Observation& observation) {
    const std::string_view kind = run_kind(scenario).name;
    if (kind == kRunAsSingleLight) {
        SingleLightOptions options;
        options.observation = observation;
        return outcomes_of(run_single_light(scenario, options).runs);
    }
    if (kind == kRunAsIntersection) {
        const IntersectionReport report = run_intersections(scenario, {1, 0.0, {}, observation});
        note_starvation(report.starvations());
        return outcomes_of(report.populations);
    }
    const NetworkReport report = run_networks(scenario, {1, {}, observation});
    note_starvation(report.starvations());
    return outcomes_of(report.populations);
}

// Returns the model of a run, as run_all() makes it.
Model model_of(const Scenario& scenario, std::size_t population) {
    const std::string_view kind = run_kind(scenario).name;
    if (kind == kRunAsNetwork) return network_model(scenario, population);
    return build_model(scenario, population);
}

// Returns true if the rules and the signal of an intersection prevent deadlocks: vehicles keep the intersection clear,
// and the time between two greens suffices for the slowest crossing.
bool prevents_deadlocks(const Scenario& scenario, const Model& model) {
    double clearance_s = scenario.signal.yellow_s + scenario.signal.all_red_s;
    if (!scenario.signal.phases.empty()) clearance_s = std::numeric_limits<double>::infinity();
    for (const PhaseSettings& phase : scenario.signal.phases)
        clearance_s = std::min(clearance_s, phase.yellow_s + phase.all_red_s);
    double slowest_s = 0.0;
    for (const Lane& connection : model.graph.lanes) {
        if (connection.origin < 0) continue;
        const double length_m = connection.length_m + connection.shape_start_m + longest_vehicle_m(scenario);
        slowest_s = std::max(slowest_s, length_m / connection.limit_mps);
    }
    return scenario.rules.keep_clear == "on" && clearance_s >= slowest_s;
}

void check_violations(const Scenario& scenario, const Outcome& outcome, Results& results) {
    const Violations& v = outcome.violations;
    const Model model = build_model(scenario, 0);
    const Violation& first = v.first;
    const std::string where = first.lane < 0 ? "?" : model.graph.lanes[at(first.lane)].name;
    const std::string place =
        fmt::format("at {} s on {}, vehicles {} and {}", first.time_s, where, first.vehicle, first.other);
    const auto check = [&](const char* name, std::int64_t count) {
        if (count != 0) results.fail(name, fmt::format("{}: {} times, first {}", outcome.population, count, place));
    };
    check("overlap", v.overlaps);
    check("conflict", v.conflicts);
    check("red_entry", v.red_entries);
    check("lost_vehicle", v.lost_vehicles);
    if (v.deadlocks != 0 && !prevents_deadlocks(scenario, model)) {
        fmt::print("deadlock_expected\t{}\n", outcome.population);
    } else {
        check("deadlock", v.deadlocks);
    }
}

std::uint64_t hash_at(const Model& model, int threads, std::int64_t tick) {
    Simulation simulation(model, threads);
    while (simulation.state().tick < tick) simulation.step();
    return simulation.state_hash();
}

// Explains why a second run, with scalar kernels, ends with another hash.
std::string difference_text(const Model& model, const Model& scalar_model, std::int64_t end_tick) {
    Simulation simulation(model);
    Simulation scalar(scalar_model);
    while (simulation.state().tick < end_tick) {
        simulation.step();
        scalar.step();
        if (simulation.state_hash() != scalar.state_hash())
            return fmt::format("scalar kernels give another state hash from {:.3f} s on", simulation.time_s());
    }
    return "a second run gives another state hash";
}

// Returns true if the reference engine covers the scenario (tests/README.md).
bool reference_covers(const Scenario& scenario, const Model& model) {
    const auto has_covered_driver = [&](const PopulationSettings::Component* component) {
        const DriverSettings& driver = driver_of(scenario, *component);
        return driver.v2v.channel == "ideal" && driver.lane_change.gap_opening != "cooperative" &&
               driver.speed_advice.mode == "off" && (scenario.is_meso() || driver.platoon.max_vehicles == "none");
    };
    const std::vector<const PopulationSettings::Component*> components = all_components(scenario);
    return std::all_of(model.signals.begin(), model.signals.end(),
                       [](const SignalPlan& plan) { return plan.controller->follows_programme; }) &&
           std::all_of(components.begin(), components.end(), has_covered_driver) &&
           scenario.signal.programmes.empty() && scenario.demand.approaches.empty() &&
           !model.demand.has_arrival_times && scenario.rules.teleport_cycles == 0.0 &&
           scenario.rules.pass_blocker_greens == 0.0 && scenario.rules.clearing == "off" && !model.v2v_plan.is_active &&
           scenario.network.vehicles == "from_scenario";
}

// Compares the first part of the run of the first population.
void compare_with_reference(const Scenario& scenario, double end_s, Results& results) {
    using namespace reference_engine;
    const Model model = build_model(scenario, 0);
    if (!reference_covers(scenario, model)) return;
    const double until_s = std::min(end_s, scenario.is_meso() ? 90.0 : 30.0);
    const Tolerance tolerance = scenario.is_meso() ? kMesoTolerance : kFullTolerance;
    const Comparison comparison = SideBySide(scenario, model, tolerance, {}).run(until_s);
    fmt::print("compared\t{}\n", comparison.uncovered_event);
    if (!comparison.difference) return;
    if (is_decided_by_rounding(scenario, model, comparison.difference->step, tolerance)) {
        fmt::print("rounding\t{}\n", comparison.difference->text());
    } else {
        results.fail("reference", comparison.difference->text());
    }
}

void check_scenario(const Scenario& scenario, const std::set<std::string>& words, Results& results) {
    std::vector<campaign::MotionCheck> motion(scenario.populations.size());
    std::vector<std::int64_t> end_tick(scenario.populations.size(), 0);
    Observation observation;
    observation.look = [&](std::size_t population, const Simulation& simulation) {
        motion[population].observe(simulation);
        end_tick[population] = simulation.state().tick;
    };
    const std::vector<Outcome> outcomes = run_all(scenario, observation);
    for (std::size_t k = 0; k < outcomes.size(); ++k) {
        check_violations(scenario, outcomes[k], results);
        if (!motion[k].fault().empty()) results.fail("motion", outcomes[k].population + ": " + motion[k].fault());
        const Model model = model_of(scenario, k);
        Model scalar_model = model;
        scalar_model.scalar_kernels = true;
        if (hash_at(scalar_model, 1, end_tick[k]) != outcomes[k].hash)
            results.fail("repeat", outcomes[k].population + ": " + difference_text(model, scalar_model, end_tick[k]));
        if (words.count("threads") == 0) continue;
        const std::int64_t part = std::min(end_tick[k], to_ticks(20.0, model.step_s));
        if (hash_at(model, 1, part) != hash_at(model, 2, part))
            results.fail("threads", outcomes[k].population + ": another state hash on two threads");
    }
    if (words.count("reference") > 0)
        compare_with_reference(scenario, scenario.tick_s() * static_cast<double>(end_tick[0]), results);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        fmt::print(stderr, "usage: stopline_check_scenario FILE [reference] [threads]\n");
        return 2;
    }
    const std::set<std::string> words(argv + 2, argv + argc);
    Results results;
    try {
        check_scenario(load_scenario(argv[1]), words, results);
    } catch (const InputError& error) {
        fmt::print("refused\t{}\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        results.fail("exception", error.what());
    }
    return results.has_failed() ? 1 : 0;
}

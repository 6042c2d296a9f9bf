// Signals with phases at intersections and in grids: checks, signal groups and right of way.
#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/containers/index.h"
#include "base/nearest_name.h"
#include "network/conflicts.h"
#include "network/movement_groups.h"
#include "scenario/kinds/kind_parts.h"
#include "scenario/make_network.h"
#include "scenario/schema/quantity.h"

namespace stopline {

namespace {

// --- Checks -------------------------------------------------------------------------------------------------------

// A movement as a phase names it.
struct NamedMovement {
    std::string name;
    std::string field;  // path of the field that names it
    bool is_protected = false;
    Turn turn = Turn::straight;
};

// Checks the phases of the scenario against the lanes of the intersection.
class PhaseChecker {
public:
    PhaseChecker(const Scenario& scenario, Checker& check)
        : scenario_(scenario), check_(check), names_(movement_names(scenario.network.intersection)) {
        const LaneGraph graph = make_intersection(scenario.network.intersection);
        for (std::size_t lane = 0; lane < graph.conflicts.size(); ++lane) {
            for (const Conflict& conflict : graph.conflicts[lane]) {
                conflicts_[{movement_name(graph, static_cast<int>(lane)), movement_name(graph, conflict.other)}] = true;
            }
            if (graph.lanes[lane].origin >= 0)
                turns_[movement_name(graph, static_cast<int>(lane))] = graph.lanes[lane].turn;
        }
    }

    // `field`: path of the list of phases.
    void check_programme(const std::vector<PhaseSettings>& phases, const std::string& field) {
        std::vector<std::string> served;
        for (std::size_t k = 0; k < phases.size(); ++k) {
            const std::string phase = fmt::format("{}[{}]", field, k);
            check_times(phases[k], phase);
            const std::vector<NamedMovement> movements = movements_of(phases[k], phase);
            for (const NamedMovement& movement : movements) served.push_back(movement.name);
            if (!runs_rings()) check_pairs(movements, fmt::format("phase {}", k + 1));
            movements_.push_back(movements);
        }
        if (runs_rings()) check_ring_pairs();
        std::vector<std::string> missing;
        for (const std::string& name : names_) {
            if (std::find(served.begin(), served.end(), name) == served.end()) missing.push_back(name);
        }
        if (missing.empty()) return;
        check_.error(
            field, fmt::format("each movement needs green in some phase; without green: {}", fmt::join(missing, ", ")));
    }

private:
    void check_times(const PhaseSettings& phase, const std::string& field) {
        check_whole_steps(scenario_, field + ".green", phase.green_s, check_);
        check_whole_steps(scenario_, field + ".yellow", phase.yellow_s, check_);
        check_whole_steps(scenario_, field + ".all_red", phase.all_red_s, check_);
        check_whole_steps(scenario_, field + ".min_green", phase.min_green_s, check_);
        check_whole_steps(scenario_, field + ".max_green", phase.max_green_s, check_);
        check_whole_steps(scenario_, field + ".gap", phase.gap_s, check_);
        if (!runs_rings()) refuse_ring_fields(field);
        if (!find_signal_controller(scenario_.signal.controller).follows_programme) return;
        for (const char* const name : {".min_green", ".max_green", ".gap", ".recall"}) {
            if (!check_.given(field + name)) continue;
            check_.error(field + name, "has no effect with the controller " + scenario_.signal.controller +
                                           ": its green is constant");
        }
    }

    void refuse_ring_fields(const std::string& field) {
        for (const char* const name : {".ring", ".barrier", ".dual_entry", ".coordinated"}) {
            if (!check_.given(field + name)) continue;
            check_.error(field + name, "has no effect with the controller " + scenario_.signal.controller +
                                           ": its phases run one after the other");
        }
    }

    std::vector<NamedMovement> movements_of(const PhaseSettings& phase, const std::string& field) {
        std::vector<NamedMovement> movements;
        const auto add = [&](const std::vector<std::string>& names, bool is_protected) {
            for (std::size_t k = 0; k < names.size(); ++k) {
                const std::string place = fmt::format("{}.{}[{}]", field, is_protected ? "protected" : "permissive", k);
                if (std::find(names_.begin(), names_.end(), names[k]) == names_.end()) {
                    check_.error(place, fmt::format("there is no movement '{}'{}", names[k],
                                                    known_names_hint(names[k], names_)));
                } else if (std::any_of(movements.begin(), movements.end(),
                                       [&](const NamedMovement& known) { return known.name == names[k]; })) {
                    check_.error(place, fmt::format("the phase names the movement {} twice", names[k]));
                } else {
                    movements.push_back({names[k], place, is_protected, turns_[names[k]]});
                }
            }
        };
        add(phase.protected_movements, true);
        add(phase.permissive_movements, false);
        return movements;
    }

    // Checks the movements that have green together in two rings. A phase whose movements conflict is not checked
    // together with other phases.
    void check_ring_pairs() {
        std::vector<bool> has_conflict(movements_.size());
        for (const RingPair& pair : make_ring_plan(scenario_.signal, {}, scenario_.tick_s()).pairs) {
            std::vector<NamedMovement> movements;
            bool is_known = false;
            for (const int phase : pair.phase) {
                if (phase < 0) continue;
                is_known = is_known || (pair.phase[0] >= 0 && pair.phase[1] >= 0 && has_conflict[at(phase)]);
                for (const NamedMovement& movement : movements_[at(phase)]) add_movement(movement, movements);
            }
            if (is_known || !check_pairs(movements, pair_text(pair))) continue;
            for (const int phase : pair.phase) {
                if (phase >= 0) has_conflict[at(phase)] = true;
            }
        }
    }

    // Adds a movement. It stays protected if one of its phases protects it.
    static void add_movement(const NamedMovement& movement, std::vector<NamedMovement>& movements) {
        const auto known = std::find_if(movements.begin(), movements.end(),
                                        [&](const NamedMovement& one) { return one.name == movement.name; });
        if (known == movements.end()) {
            movements.push_back(movement);
        } else if (movement.is_protected) {
            *known = movement;
        }
    }

    // Reports two movements that conflict in the same phase or phases, if neither yields to the other. Returns true if
    // there are such movements.
    bool check_pairs(const std::vector<NamedMovement>& movements, const std::string& phases) {
        bool has_conflict = false;
        for (std::size_t k = 0; k < movements.size(); ++k) {
            for (std::size_t m = k + 1; m < movements.size(); ++m) {
                const NamedMovement& one = movements[k];
                const NamedMovement& two = movements[m];
                if (one.is_protected != two.is_protected || !conflicts_.contains({one.name, two.name})) continue;
                if (one.is_protected) {
                    has_conflict = true;
                    check_.error(two.field, fmt::format("the protected movements {} and {} of {} conflict: make one "
                                                        "of them permissive, or give them different phases",
                                                        one.name, two.name, phases));
                } else if (!yields_by_turn(one.turn, two.turn) && !yields_by_turn(two.turn, one.turn)) {
                    has_conflict = true;
                    check_.error(two.field, fmt::format("the permissive movements {} and {} of {} conflict, and "
                                                        "neither yields to the other: give them different phases",
                                                        one.name, two.name, phases));
                }
            }
        }
        return has_conflict;
    }

    bool runs_rings() const { return find_signal_controller(scenario_.signal.controller).runs_rings; }

    const Scenario& scenario_;
    Checker& check_;
    std::vector<std::string> names_;  // all movements of the intersection
    std::map<std::pair<std::string, std::string>, bool> conflicts_;
    std::map<std::string, Turn> turns_;
    std::vector<std::vector<NamedMovement>> movements_;  // [phase] of the programme
};

// Reports fields of the section `signal` that have no effect beside phases.
void refuse_stage_times(Checker& check) {
    for (const char* const name : {"green", "cross_green", "yellow", "all_red"}) {
        if (!check.given(std::string("signal.") + name)) continue;
        check.error(std::string("signal.") + name, "has no effect: the phases have times of their own");
    }
}

void check_times_of_day(const SignalSettings& signal, Checker& check) {
    for (std::size_t k = 1; k < signal.programmes.size(); ++k) {
        if (signal.programmes[k].from_s > signal.programmes[k - 1].from_s) continue;
        check.error(fmt::format("signal.programmes[{}].from", k),
                    short_text(signal.programmes[k].from_s, unit("h")) +
                        " is not after the start of the programme before it, " +
                        short_text(signal.programmes[k - 1].from_s, unit("h")));
    }
    if (signal.clock_s > 0.0 && signal.programmes.empty()) {
        check.error("signal.clock", "has no effect without signal.programmes");
    }
}

// --- Model --------------------------------------------------------------------------------------------------------

// Returns the right of way of two conflicting connections in a phase. Returns nothing unless both have green. `names`:
// the movement of each connection.
std::optional<Priority> priority_in(const PhaseSettings& phase, const LaneGraph& graph,
                                    const std::vector<std::string>& names, int first, int second) {
    const std::string& first_name = names[at(first)];
    const std::string& second_name = names[at(second)];
    if (!has_green(phase, first_name) || !has_green(phase, second_name)) return std::nullopt;
    const auto is_protected = [&](const std::string& name) {
        const std::vector<std::string>& movements = phase.protected_movements;
        return std::find(movements.begin(), movements.end(), name) != movements.end();
    };
    if (is_protected(first_name) != is_protected(second_name))
        return Priority{!is_protected(first_name), !is_protected(second_name)};
    const Turn first_turn = graph.lanes[at(first)].turn;
    const Turn second_turn = graph.lanes[at(second)].turn;
    return Priority{yields_by_turn(first_turn, second_turn), yields_by_turn(second_turn, first_turn)};
}

void set_static_priority(LaneGraph& graph, int lane, int other, bool yields, bool other_yields) {
    for (Conflict& conflict : graph.conflicts[at(lane)]) {
        if (conflict.other != other) continue;
        conflict.yields = yields;
        conflict.other_yields = other_yields;
    }
}

// Sets the right of way of all conflicting connections. `groups`: number of signal groups of each intersection.
void set_priorities(const std::vector<ProgrammeSettings>& programmes, int groups, Model& model) {
    std::vector<std::string> names(model.graph.lanes.size());
    for (std::size_t lane = 0; lane < names.size(); ++lane) {
        if (model.graph.lanes[lane].origin >= 0) names[lane] = movement_name(model.graph, static_cast<int>(lane));
    }
    for (int first = 0; first < static_cast<int>(model.graph.conflicts.size()); ++first) {
        const std::vector<Conflict> conflicts = model.graph.conflicts[at(first)];
        for (const Conflict& conflict : conflicts) {
            if (conflict.other < first) continue;
            const int origin = model.graph.lanes[at(first)].origin;
            const int signal = model.graph.lanes[at(origin)].signal_group / groups;
            PriorityByPhase changing{signal, first, conflict.other, {}};
            std::vector<Priority> known;  // without those of phases in which not both connections have green
            for (const ProgrammeSettings& programme : programmes) {
                for (const PhaseSettings& phase : programme.phases) {
                    changing.by_phase.push_back(priority_in(phase, model.graph, names, first, conflict.other));
                    if (changing.by_phase.back()) known.push_back(*changing.by_phase.back());
                }
            }
            const Priority initial = known.empty() ? Priority{} : known.front();
            set_static_priority(model.graph, first, conflict.other, initial.first_yields, initial.second_yields);
            set_static_priority(model.graph, conflict.other, first, initial.second_yields, initial.first_yields);
            if (std::count(known.begin(), known.end(), initial) == std::ssize(known)) continue;
            model.priorities_by_phase.push_back(std::move(changing));
        }
    }
}

std::vector<int> groups_of(const Scenario& scenario, const std::vector<std::string>& movements) {
    return groups_with_equal_lights(scenario.signal, movements,
                                    find_signal_controller(scenario.signal.controller).runs_rings);
}

}  // namespace

void check_phases(const Scenario& scenario, Checker& check) {
    const SignalSettings& signal = scenario.signal;
    check_times_of_day(signal, check);
    if (!signal.has_phases()) return;
    if (!signal.phases.empty() && !signal.programmes.empty()) {
        return check.error("signal.programmes", "cannot be combined with signal.phases: give only one of them");
    }
    if (!find_signal_controller(signal.controller).runs_phases) {
        return check.error("signal.controller", fmt::format("'{}' cannot run phases", signal.controller));
    }
    if (find_signal_controller(signal.controller).runs_rings && !signal.programmes.empty()) {
        return check.error("signal.programmes",
                           fmt::format("'{}' has a single programme: use signal.phases", signal.controller));
    }
    refuse_stage_times(check);
    PhaseChecker phases(scenario, check);
    if (!signal.phases.empty()) phases.check_programme(signal.phases, "signal.phases");
    for (std::size_t k = 0; k < signal.programmes.size(); ++k) {
        phases.check_programme(signal.programmes[k].phases, fmt::format("signal.programmes[{}].phases", k));
    }
}

void assign_phase_groups(const Scenario& scenario, LaneGraph& graph) {
    if (!scenario.signal.has_phases()) return;
    const std::vector<std::string> movements = movement_names(scenario.network.intersection);
    assign_movement_groups(graph, movements, groups_of(scenario, movements));
}

void add_phase_signals(const Scenario& scenario, const std::vector<double>& first_green_s, Model& model) {
    assign_phase_groups(scenario, model.graph);
    // One movement stands for all movements of its group.
    const std::vector<std::string> movements = movement_names(scenario.network.intersection);
    const std::vector<int> groups = groups_of(scenario, movements);
    std::vector<std::string> of_group;
    for (std::size_t k = 0; k < movements.size(); ++k) {
        if (at(groups[k]) == of_group.size()) of_group.push_back(movements[k]);
    }
    // A run without a given duration ends after its measured cycles.
    const MeasureSettings& measure = scenario.measure;
    const double cycles_s = (measure.warmup_cycles + measure.cycles + 1) * scenario.nominal_cycle().cycle_s;
    const double end_s = scenario.duration_s > 0.0 ? scenario.duration_s : scenario.signal.first_green_s + cycles_s;
    for (const double start_s : first_green_s) {
        SignalSettings signal = scenario.signal;
        signal.first_green_s = start_s;
        model.signals.add(make_phase_signal_plan(signal, model.signals.groups(), of_group, scenario.tick_s(),
                                                 to_ticks(end_s, scenario.tick_s())));
    }
    const bool runs_rings = find_signal_controller(scenario.signal.controller).runs_rings;
    set_priorities(runs_rings ? std::vector<ProgrammeSettings>{{0.0, ring_pair_phases(scenario.signal)}}
                              : phase_programmes(scenario.signal),
                   static_cast<int>(of_group.size()), model);
}

}  // namespace stopline

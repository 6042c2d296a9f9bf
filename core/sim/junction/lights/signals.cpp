#include "sim/junction/lights/signals.h"

#include <algorithm>
#include <limits>

#include "base/containers/index.h"
#include "signals/signal_controller.h"
#include "sim/junction/lights/announced_platoon.h"
#include "sim/state/queries/covered_detector.h"

namespace stopline {

namespace {

// Returns the groups of a signal that control movements of a lane. Bit k stands for group k of the signal.
std::uint64_t groups_of(const LaneGraph& graph, const SignalPlan& plan, const Lane& lane) {
    std::uint64_t groups = 0;
    const auto add = [&](int group) {
        const auto found = std::find(plan.groups.begin(), plan.groups.end(), group);
        if (found != plan.groups.end()) groups |= std::uint64_t{1} << (found - plan.groups.begin());
    };
    for (const int connection : lane.next) {
        const int own = graph.lanes[at(connection)].movement_signal_group;
        add(own >= 0 ? own : lane.signal_group);
    }
    return groups;
}

// Returns the phases of the imported detector at this place, or 0 if the detectors of the signal are not imported.
std::uint64_t phases_of(const SignalPlan& plan, const Detector& detector) {
    for (const LaneDetector& one : plan.lane_detectors) {
        if (one.lane == detector.lane) return one.phases;
    }
    return 0;
}

// Returns all detectors on the approach lanes of each signal whose controller reads detectors, in the order of
// Model::detectors.
std::vector<std::vector<SignalDetector>> signal_detectors(const Model& model) {
    struct Place {
        std::size_t signal = 0;
        int group = -1;
    };
    std::vector<Place> places(at(model.graph.signal_groups));  // [signal group]
    for (std::size_t signal = 0; signal < model.signals.size(); ++signal) {
        const SignalPlan& plan = model.signals[signal];
        if (plan.controller->follows_programme) continue;
        for (std::size_t k = 0; k < plan.groups.size(); ++k) {
            places[at(plan.groups[k])] = {signal, static_cast<int>(k)};
        }
    }
    std::vector<std::vector<SignalDetector>> detectors(model.signals.size());
    for (std::size_t number = 0; number < model.detectors.size(); ++number) {
        const Detector& detector = model.detectors[number];
        if (detector.lane < 0) continue;
        const Lane& lane = model.graph.lanes[at(detector.lane)];
        if (lane.signal_group < 0 || places[at(lane.signal_group)].group < 0) continue;
        const Place& place = places[at(lane.signal_group)];
        detectors[place.signal].push_back({static_cast<int>(number), place.group,
                                           groups_of(model.graph, model.signals[place.signal], lane),
                                           lane.stop_line_m - detector.position_m});
        if (detector.kind == Detector::Kind::signal)
            detectors[place.signal].back().phases = phases_of(model.signals[place.signal], detector);
    }
    return detectors;
}

// Reads the detectors of a signal, and the announcements of platoons if its controller hears them.
void read_detectors(const Model& model, const State& state, const SignalPlan& plan,
                    std::vector<SignalDetector>& detectors) {
    auto* const range_of = plan.controller->platoon_range_m;
    const double platoon_range_m = range_of == nullptr ? 0.0 : range_of(plan);
    for (SignalDetector& detector : detectors) {
        detector.is_occupied = is_covered(model, state, at(detector.number));
        if (detector.is_occupied) detector.last_occupied_tick = state.tick;
        detector.last_crossing_tick = state.detectors.last_crossing_tick[at(detector.number)];
        if (platoon_range_m <= 0.0) continue;
        const AnnouncedPlatoon platoon =
            announced_platoon(model, state, model.detectors[at(detector.number)].lane, platoon_range_m);
        detector.platoon_rear_tick = platoon.rear_tick;
        detector.platoon_can_wait = platoon.can_wait;
    }
}

}  // namespace

void start_signals(const Model& model, State& state) {
    SignalState& signals = state.signals;
    const std::size_t groups = at(model.graph.signal_groups);
    signals.lights.assign(groups, Light::red);
    signals.since_tick.assign(groups, 0);
    signals.green_start_tick.assign(groups, kNoGreen);
    signals.phase.assign(model.signals.size(), -1);
    signals.phase_start_tick.assign(model.signals.size(), -1);
    signals.next_step_tick.assign(model.signals.size(), 0);
    signals.memory.resize(model.signals.size());
    signals.detectors = signal_detectors(model);
    signals.first_step_tick = std::numeric_limits<std::int64_t>::max();
    for (std::size_t signal = 0; signal < model.signals.size(); ++signal) {
        const SignalPlan& plan = model.signals[signal];
        if (plan.controller->memory_size != nullptr) {
            signals.memory[signal].assign(plan.controller->memory_size(plan), 0);
        }
        read_detectors(model, state, plan, signals.detectors[signal]);
        SignalView view(plan, signal, state.tick, signals);
        signals.next_step_tick[signal] = plan.controller->init(view);
        signals.first_step_tick = std::min(signals.first_step_tick, signals.next_step_tick[signal]);
    }
    // Detectors are read in every step, so that each step finds the latest tick at which they were occupied.
    for (const std::vector<SignalDetector>& detectors : signals.detectors) {
        if (!detectors.empty()) signals.first_step_tick = 0;
    }
}

void update_signals(const Model& model, State& state) {
    SignalState& signals = state.signals;
    if (state.tick < signals.first_step_tick) return;
    std::int64_t first_tick = std::numeric_limits<std::int64_t>::max();
    for (std::size_t signal = 0; signal < model.signals.size(); ++signal) {
        if (!signals.detectors[signal].empty()) {
            read_detectors(model, state, model.signals[signal], signals.detectors[signal]);
            first_tick = state.tick + 1;
        }
        if (state.tick >= signals.next_step_tick[signal]) {
            const SignalPlan& plan = model.signals[signal];
            SignalView view(plan, signal, state.tick, signals);
            signals.next_step_tick[signal] = plan.controller->step(view);
        }
        first_tick = std::min(first_tick, signals.next_step_tick[signal]);
    }
    signals.first_step_tick = first_tick;
}

void add_signals(const Model& model, const State& state, StateHash& hash) {
    for (std::size_t signal = 0; signal < model.signals.size(); ++signal) {
        const SignalPlan& plan = model.signals[signal];
        if (plan.controller->follows_programme) continue;
        for (const int group : plan.groups) {
            hash.add(static_cast<int>(state.signals.lights[at(group)]));
            hash.add(state.signals.since_tick[at(group)]);
        }
        for (const std::int64_t number : state.signals.memory[signal]) hash.add(number);
    }
}

}  // namespace stopline

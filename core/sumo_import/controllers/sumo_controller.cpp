#include "sumo_import/controllers/sumo_controller.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/input_error.h"

namespace stopline {

void set_sumo_controllers(SumoNet& net) {
    constexpr std::size_t kMaxLinks = 64;  // bits of SignalPhase::green_groups
    for (SumoSignal& signal : net.signals) {
        if (signal.type.empty() || signal.type == "static" || signal.phases.empty()) continue;
        const std::vector<SumoPhase> file_phases = signal.phases;
        if (signal.phases[0].state.size() > kMaxLinks) {
            net.warnings.note(signal.where, "signals that react to traffic can have at most 64 links");
        } else if (signal.type == "actuated") {
            set_actuated_controller(signal, net.warnings);
        } else if (signal.type == "NEMA") {
            set_nema_controller(signal, net.warnings);
        }
        if (signal.controller != nullptr) {
            signal.controller->file_phases = file_phases;
            continue;
        }
        net.warnings.note(
            signal.where,
            fmt::format("signals of type '{}' run as fixed-time signals with the durations of the file", signal.type));
    }
}

void note_unknown_parameters(const SumoSignal& signal, const std::vector<std::string>& known, SumoWarnings& warnings) {
    for (const auto& [name, value] : signal.parameters) {
        const auto begins = [&, &key = name](const std::string& one) { return key.starts_with(one); };
        if (std::any_of(known.begin(), known.end(), begins)) continue;
        warnings.note(signal.where,
                      fmt::format("the parameter '{}' of signals of type '{}' is ignored", name, signal.type));
    }
}

double sumo_parameter(const SumoSignal& signal, const std::string& name, double fallback) {
    const auto found = signal.parameters.find(name);
    if (found == signal.parameters.end()) return fallback;
    const std::optional<double> value = sumo_number(found->second);
    if (value && *value >= 0.0) return *value;
    throw InputError(fmt::format("{}: parameter '{}' has the value '{}': it must be a number of at least 0",
                                 signal.where, name, found->second));
}

namespace {

// A lane with links of one signal.
struct ControlledLane {
    int lane = -1;  // lane of the graph
    double length_m = 0.0;
    double speed_mps = 0.0;
    std::vector<const BuiltConnection*> connections;
};

bool has_letter(const ControlledLane& lane, const std::string& state, char letter) {
    return std::any_of(lane.connections.begin(), lane.connections.end(), [&](const BuiltConnection* connection) {
        return state[at(connection->source->tl_link)] == letter;
    });
}

// Returns true if vehicles on the lane extend an actuated phase: all movements of the lane have green. A minor green
// counts if the lane also has a major green in this phase and the movement never has a major green, or if the edge has
// only one lane.
bool extends(const ControlledLane& lane, const SumoController& controller, const std::string& state,
             const LaneGraph& graph) {
    const Lane& road = graph.lanes[at(lane.lane)];
    const bool is_only_lane = road.left < 0 && road.right < 0;
    return std::all_of(lane.connections.begin(), lane.connections.end(), [&](const BuiltConnection* connection) {
        const std::size_t link = at(connection->source->tl_link);
        if (state[link] == 'G') return true;
        if (state[link] != 'g') return false;
        const bool never_major = std::none_of(controller.states.begin(), controller.states.end(),
                                              [&](const std::string& one) { return one[link] == 'G'; });
        return is_only_lane || (never_major && has_letter(lane, state, 'G'));
    });
}

void place_actuated(const SumoSignal& signal, const ControlledLane& lane, SumoController& controller,
                    const LaneGraph& graph) {
    constexpr double kVehicleSpace_m = 7.5;
    LaneDetector detector{lane.lane, sumo_parameter(signal, "detector-gap", 2.0) * lane.speed_mps, 0.0, 0};
    const double passing_s = sumo_parameter(signal, "passing-time", 1.9);
    for (std::size_t k = 0; k < controller.states.size(); ++k) {
        const PhaseSettings& phase = controller.settings.phases[k];
        const std::string& state = controller.states[k];
        if (phase.min_green_s >= phase.max_green_s) continue;
        if (has_letter(lane, state, 'G') || has_letter(lane, state, 'g')) {
            detector.to_line_m = std::min(detector.to_line_m, (phase.min_green_s / passing_s + 0.5) * kVehicleSpace_m);
        }
        if (extends(lane, controller, state, graph)) detector.phases |= std::uint64_t{1} << k;
    }
    if (detector.phases != 0) controller.detectors.push_back(detector);
}

void place_nema(const SumoSignal& signal, const ControlledLane& lane, SumoController& controller) {
    const bool is_left_lane = lane.connections.size() == 1 && lane.connections[0]->source->dir == 'l';
    const double length_m =
        sumo_parameter(signal, is_left_lane ? "detector-length-leftTurnLane" : "detector-length", 20.0);
    LaneDetector detector{lane.lane, length_m, length_m, 0};
    for (std::size_t k = 0; k < controller.states.size(); ++k) {
        if (has_letter(lane, controller.states[k], 'G')) detector.phases |= std::uint64_t{1} << k;
    }
    if (detector.phases != 0) controller.detectors.push_back(detector);
}

}  // namespace

void place_sumo_detectors(SumoNetwork& network, const std::vector<BuiltConnection>& connections) {
    constexpr double kFromStart_m = 0.1;
    std::map<std::pair<int, int>, ControlledLane> lanes;  // [signal, lane of the graph]
    for (const BuiltConnection& connection : connections) {
        const int tl = connection.source->tl;
        if (tl < 0 || network.net.signals[at(tl)].controller == nullptr) continue;
        const int origin = network.graph.lanes[at(connection.lane)].origin;
        const Lane& road = network.graph.lanes[at(origin)];
        ControlledLane& lane = lanes[{tl, origin}];
        lane = {origin, road.stop_line_m, road.limit_mps, std::move(lane.connections)};
        lane.connections.push_back(&connection);
    }
    for (const auto& [key, lane] : lanes) {
        const SumoSignal& signal = network.net.signals[at(key.first)];
        SumoController& controller = *signal.controller;
        const std::size_t count = controller.detectors.size();
        if (signal.type == "NEMA") {
            place_nema(signal, lane, controller);
        } else {
            place_actuated(signal, lane, controller, network.graph);
        }
        if (controller.detectors.size() == count) continue;
        LaneDetector& detector = controller.detectors.back();
        const double longest_m = std::max(lane.length_m - kFromStart_m, 0.5 * lane.length_m);
        if (detector.to_line_m <= longest_m) continue;
        detector.to_line_m = longest_m;
        detector.length_m = std::min(detector.length_m, longest_m);
        network.net.warnings.note(signal.where,
                                  "the lane of a detector is too short: the detector begins with the lane");
    }
}

}  // namespace stopline

#include "sumo_import/sumo_signal_file.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/text_hash.h"

namespace stopline {

namespace {

constexpr double kMaxDuration_s = 1e6;
constexpr double kMaxGreen_s = 1e10;       // of minDur and maxDur
constexpr double kMaxClearance_s = 300.0;  // of yellow, red and vehext, which become times of the two rings

void read_next(const SumoXml& xml, pugi::xml_node node, SumoPhase& phase) {
    for (const std::string_view word : sumo_words(node.attribute("next").value())) {
        const std::optional<double> number = sumo_number(word);
        if (!number || *number < 0.0 || *number != std::floor(*number) || *number > 1e6)
            xml.refuse(node, fmt::format("next=\"{}\" must be numbers of phases", node.attribute("next").value()));
        phase.next.push_back(static_cast<int>(*number));
    }
}

SumoPhase phase_of(const SumoXml& xml, pugi::xml_node node, SumoWarnings& warnings) {
    constexpr std::string_view kLetters = "rugGyYsoO";
    SumoPhase phase{xml.number(node, "duration"), xml.text(node, "state")};
    if (!(phase.duration_s > 0.0) || phase.duration_s > kMaxDuration_s) {
        xml.refuse(node, fmt::format("duration=\"{}\" must be more than 0 and at most {} s",
                                     node.attribute("duration").value(), kMaxDuration_s));
    }
    const std::size_t unknown = phase.state.find_first_not_of(kLetters);
    if (unknown != std::string::npos) {
        xml.refuse(node,
                   fmt::format("'state' has the unknown letter '{}'; known are {}", phase.state[unknown], kLetters));
    }
    if (phase.state.find('s') != std::string::npos) {
        warnings.note(xml.where(node), "the letter 's' is read as 'g': vehicles do not stop first");
    }
    phase.name = node.attribute("name").value();
    phase.min_s = xml.number_or(node, "minDur", phase.duration_s);
    phase.max_s = xml.number_or(node, "maxDur", node.attribute("minDur") ? kMaxDuration_s : phase.duration_s);
    phase.extension_s = xml.number_or(node, "vehext", 2.0);
    phase.yellow_s = xml.number_or(node, "yellow", 3.0);
    phase.red_s = xml.number_or(node, "red", 2.0);
    for (const char* const name : {"minDur", "maxDur", "vehext", "yellow", "red"}) {
        const double value_s = xml.number_or(node, name, 0.0);
        const double limit_s = std::string_view(name).ends_with("Dur") ? kMaxGreen_s : kMaxClearance_s;
        if (value_s >= 0.0 && value_s <= limit_s) continue;
        xml.refuse(node,
                   fmt::format("{}=\"{}\" must be from 0 to {:g} s", name, node.attribute(name).value(), limit_s));
    }
    read_next(xml, node, phase);
    return phase;
}

void read_phases(const SumoXml& xml, pugi::xml_node node, SumoSignal& signal, SumoWarnings& warnings) {
    for (const pugi::xml_node phase : node.children("phase")) {
        if (signal.phases.size() == kSumoPhasesMax) {
            xml.refuse(phase, fmt::format("tlLogic '{}' has more than {} phases", signal.id, kSumoPhasesMax));
        }
        signal.phases.push_back(phase_of(xml, phase, warnings));
        if (signal.phases.back().state.size() != signal.phases[0].state.size()) {
            xml.refuse(phase,
                       fmt::format("'state' has {} letters, but the first phase has {}; all phases need the same "
                                   "number",
                                   signal.phases.back().state.size(), signal.phases[0].state.size()));
        }
    }
    if (!signal.phases.empty() && !(signal.cycle_s() >= 1.0)) {
        xml.refuse(node, fmt::format("tlLogic '{}': the phases must last at least 1 s in total", signal.id));
    }
}

}  // namespace

void add_sumo_signal(const SumoXml& xml, pugi::xml_node node, bool from_net, SumoNet& net) {
    SumoWarnings& warnings = net.warnings;
    SumoSignal signal{xml.text(node, "id"), node.attribute("programID").value()};
    signal.where = xml.where(node);
    signal.defined_in_net = from_net;
    if (signal.programme == "off") {
        xml.refuse(node, fmt::format("tlLogic '{}': programID=\"off\" switches the signal off, which is not supported; "
                                     "remove this element, or give it phases under another programID",
                                     signal.id));
    }
    signal.offset_s = xml.number_or(node, "offset", 0.0);
    if (std::abs(signal.offset_s) > kMaxDuration_s) {
        xml.refuse(node, fmt::format("'offset' must be between -{0} and {0} s", kMaxDuration_s));
    }
    read_phases(xml, node, signal, warnings);
    signal.type = node.attribute("type").value();
    for (const pugi::xml_node parameter : node.children("param"))
        signal.parameters[xml.text(parameter, "key")] = parameter.attribute("value").value();
    for (const char* const name : {"condition", "assignment", "function"}) {
        if (node.child(name)) warnings.note(signal.where, fmt::format("'{}' of signals is ignored", name));
    }
    const auto known = net.signal_by_id.find(signal.id);
    const bool is_known = known != net.signal_by_id.end();
    const bool has_phases = is_known && !net.signals[at(known->second)].phases.empty();
    if (signal.phases.empty()) {
        if (from_net || !has_phases) {
            xml.refuse(node, fmt::format("tlLogic '{}' has no phase; it needs at least one", signal.id));
        }
        net.signals[at(known->second)].offset_s = signal.offset_s;
        return;
    }
    if (!is_known) {
        if (!from_net) xml.refuse(node, fmt::format("tlLogic '{}': the network has no signal with this id", signal.id));
        net.signal_by_id.emplace(signal.id, static_cast<int>(net.signals.size()));
        net.signals.push_back(std::move(signal));
        return;
    }
    SumoSignal& earlier = net.signals[at(known->second)];
    if (from_net && earlier.programme == signal.programme) {
        xml.refuse(node,
                   fmt::format("tlLogic '{}' has two programmes '{}'; one is allowed", signal.id, signal.programme));
    }
    if (has_phases && earlier.phases[0].state.size() > signal.phases[0].state.size()) {
        xml.refuse(node, fmt::format("tlLogic '{}': 'state' has {} letters, but an earlier programme has {}", signal.id,
                                     signal.phases[0].state.size(), earlier.phases[0].state.size()));
    }
    signal.defined_in_net = signal.defined_in_net || earlier.defined_in_net;
    earlier = std::move(signal);  // as in SUMO, the last programme replaces earlier programmes
}

namespace {

bool is_true(pugi::xml_node node, const char* attribute) {
    const std::string_view value = node.attribute(attribute).value();
    return value == "true" || value == "1" || value == "yes" || value == "on" || value == "x" || value == "t";
}

void read_loop(const SumoXml& xml, pugi::xml_node node, SumoNet& net) {
    const std::string lane = xml.text(node, "lane");
    const auto edge_and_index = net.lane(lane);
    if (!edge_and_index) xml.refuse(node, fmt::format("lane=\"{}\": the network has no lane with this id", lane));
    SumoLoop loop{xml.text(node, "id"), edge_and_index->first, edge_and_index->second, xml.number(node, "pos"),
                  xml.where(node)};
    const double length_m = net.edges[at(loop.edge)].lanes[at(loop.lane)].length_m;
    if (loop.position_m < 0.0) loop.position_m += length_m;  // a negative position counts from the end of the lane
    if (is_true(node, "friendlyPos")) loop.position_m = std::clamp(loop.position_m, 0.0, length_m);
    if (loop.position_m < 0.0 || loop.position_m > length_m) {
        xml.refuse(node, fmt::format("pos=\"{}\" must lie on the lane, which is {:.2f} m long",
                                     node.attribute("pos").value(), length_m));
    }
    for (const char* const ignored : {"vTypes", "nextEdges", "detectPersons"}) {
        if (!node.attribute(ignored)) continue;
        net.warnings.note(loop.where, fmt::format("'{}' is ignored: the detector counts all vehicles", ignored));
    }
    if (!net.loop_ids.insert(loop.id).second) {
        xml.refuse(node, fmt::format("there are two detectors '{}'; ids must be unique", loop.id));
    }
    net.loops.push_back(std::move(loop));
}

}  // namespace

void read_sumo_additional(const std::filesystem::path& file, SumoNet& net) {
    const SumoXml xml(file, {"additional", "tlLogics", "add", "routes"});
    SumoWarnings& warnings = net.warnings;
    constexpr std::string_view kTraffic = " vType vTypeDistribution route routeDistribution vehicle trip flow ";
    for (const pugi::xml_node node : xml.root()) {
        const std::string_view name = node.name();
        if (name == "tlLogic") {
            add_sumo_signal(xml, node, false, net);
        } else if (name == "e1Detector" || name == "inductionLoop") {
            read_loop(xml, node, net);
        } else if (node.type() == pugi::node_element && kTraffic.find(fmt::format(" {} ", name)) == std::string::npos) {
            warnings.note(xml.where(node), fmt::format("the element '{}' is ignored", name));
        }
    }
    net.hash = extended_hash(net.hash, xml.hash());
}

}  // namespace stopline

#include "network/sumo_signal_file.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace stopline {

namespace {

constexpr double kLongest_s = 1e6;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

SumoPhase phase_of(const SumoXml& xml, pugi::xml_node node, SumoWarnings& warnings) {
    constexpr std::string_view kLetters = "rugGyYsoO";
    SumoPhase phase{xml.number(node, "duration"), xml.text(node, "state")};
    if (phase.duration_s < 0.0 || phase.duration_s > kLongest_s) {
        xml.refuse(node,
                   fmt::format("duration=\"{}\" must be 0 to {} s", node.attribute("duration").value(), kLongest_s));
    }
    const std::size_t unknown = phase.state.find_first_not_of(kLetters);
    if (unknown != std::string::npos) {
        xml.refuse(node, fmt::format("state has the letter '{}' (known: {})", phase.state[unknown], kLetters));
    }
    if (phase.state.find('s') != std::string::npos) {
        warnings.note(xml.where(node), "signal state 's' is read as 'g': nobody stops first");
    }
    if (node.attribute("next")) warnings.note(xml.where(node), "'next' of a phase is not read: phases follow in order");
    return phase;
}

void read_phases(const SumoXml& xml, pugi::xml_node node, SumoSignal& signal, SumoWarnings& warnings) {
    for (const pugi::xml_node phase : node.children("phase")) {
        signal.phases.push_back(phase_of(xml, phase, warnings));
        if (signal.phases.back().state.size() != signal.phases[0].state.size()) {
            xml.refuse(phase, fmt::format("state has {} letters, the first phase {}", signal.phases.back().state.size(),
                                          signal.phases[0].state.size()));
        }
    }
    if (!signal.phases.empty() && !(signal.cycle_s() >= 1.0)) {
        xml.refuse(node, fmt::format("tlLogic '{}': the phases last less than a second", signal.id));
    }
}

}  // namespace

void add_sumo_signal(const SumoXml& xml, pugi::xml_node node, bool from_net, SumoNet& net) {
    SumoWarnings& warnings = net.warnings;
    SumoSignal signal{xml.text(node, "id"), node.attribute("programID").value()};
    signal.where = xml.where(node);
    signal.in_net = from_net;
    if (signal.programme == "off") {
        xml.refuse(node, fmt::format("tlLogic '{}': programID=\"off\" switches the light off, which is not read: leave "
                                     "this element out, or give it phases under another programID",
                                     signal.id));
    }
    signal.offset_s = xml.number_or(node, "offset", 0.0);
    if (std::abs(signal.offset_s) > kLongest_s) xml.refuse(node, "offset is too large");
    read_phases(xml, node, signal, warnings);
    const std::string type = node.attribute("type").value();
    if (!type.empty() && type != "static") {
        warnings.note(signal.where, fmt::format("signals of type '{}' run as static ones, with their durations", type));
    }
    const auto known = net.signal_by_id.find(signal.id);
    const bool is_known = known != net.signal_by_id.end();
    const bool has_phases = is_known && !net.signals[at(known->second)].phases.empty();
    if (signal.phases.empty()) {
        if (from_net || !has_phases) xml.refuse(node, fmt::format("tlLogic '{}' has no phase", signal.id));
        net.signals[at(known->second)].offset_s = signal.offset_s;
        return;
    }
    if (!is_known) {
        if (!from_net) xml.refuse(node, fmt::format("the network has no light '{}'", signal.id));
        net.signal_by_id.emplace(signal.id, static_cast<int>(net.signals.size()));
        net.signals.push_back(std::move(signal));
        return;
    }
    SumoSignal& old = net.signals[at(known->second)];
    if (from_net && old.programme == signal.programme) {
        xml.refuse(node, fmt::format("there are two programmes '{}' of tlLogic '{}'", signal.programme, signal.id));
    }
    if (has_phases && old.phases[0].state.size() > signal.phases[0].state.size()) {
        xml.refuse(node, fmt::format("tlLogic '{}': state has {} letters, the network's {}", signal.id,
                                     signal.phases[0].state.size(), old.phases[0].state.size()));
    }
    signal.in_net = signal.in_net || old.in_net;
    old = std::move(signal);  // as in SUMO, the last one is used
}

namespace {

bool is_true(pugi::xml_node node, const char* attribute) {
    const std::string_view value = node.attribute(attribute).value();
    return value == "true" || value == "1" || value == "yes" || value == "on" || value == "x" || value == "t";
}

void read_loop(const SumoXml& xml, pugi::xml_node node, SumoNet& net) {
    const std::string lane = xml.text(node, "lane");
    const auto place = net.lane(lane);
    if (!place) xml.refuse(node, fmt::format("lane: there is no lane '{}'", lane));
    SumoLoop loop{xml.text(node, "id"), place->first, place->second, xml.number(node, "pos"), xml.where(node)};
    const double length_m = net.edges[at(loop.edge)].lanes[at(loop.lane)].length_m;
    if (loop.position_m < 0.0) loop.position_m += length_m;  // counted from the end
    if (is_true(node, "friendlyPos")) loop.position_m = std::clamp(loop.position_m, 0.0, length_m);
    if (loop.position_m < 0.0 || loop.position_m > length_m) xml.refuse(node, "pos does not lie on the lane");
    for (const char* const unread : {"vTypes", "nextEdges", "detectPersons"}) {
        if (!node.attribute(unread)) continue;
        net.warnings.note(loop.where, fmt::format("'{}' of detectors is not read: all vehicles are counted", unread));
    }
    const auto same = [&](const SumoLoop& other) { return other.id == loop.id; };
    if (std::any_of(net.loops.begin(), net.loops.end(), same)) {
        xml.refuse(node, fmt::format("there are two detectors '{}'", loop.id));
    }
    net.loops.push_back(std::move(loop));
}

}  // namespace

void read_sumo_additional(const std::filesystem::path& file, SumoNet& net) {
    const SumoXml xml(file, {"additional", "tlLogics", "add", "routes"});
    SumoWarnings& warnings = net.warnings;
    constexpr std::string_view kRoutes = " vType vTypeDistribution route routeDistribution vehicle trip flow ";
    for (const pugi::xml_node node : xml.root()) {
        const std::string_view name = node.name();
        if (name == "tlLogic") {
            add_sumo_signal(xml, node, false, net);
        } else if (name == "e1Detector" || name == "inductionLoop") {
            read_loop(xml, node, net);
        } else if (node.type() == pugi::node_element && kRoutes.find(fmt::format(" {} ", name)) == std::string::npos) {
            warnings.note(xml.where(node), fmt::format("'{}' of additional files is not read", name));
        }
    }
    net.hash = net.hash * 0x100000001b3U ^ xml.hash();
}

}  // namespace stopline

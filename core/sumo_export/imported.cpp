#include "sumo_export/imported.h"

#include <algorithm>
#include <set>

#include "base/containers/index.h"
#include "base/io/escape.h"
#include "sumo_export/imported_vehicles.h"
#include "sumo_export/inputs.h"
#include "sumo_import/controllers/sumo_controller.h"

namespace stopline {

namespace {

bool has_signal(const LaneGraph& graph, const Lane& lane) {
    if (lane.origin >= 0 || lane.signal_group < 0) return false;
    return lane.signal_group > 0 || std::any_of(lane.next.begin(), lane.next.end(), [&](int connection) {
               return graph.lanes[at(connection)].movement_signal_group > 0;
           });
}

// Writes a phase of a signal that reacts to traffic, with the attributes that the import has read.
void write_controlled_phase(XmlFile& xml, const SumoSignal& signal, const SumoPhase& phase) {
    xml.add(R"(        <phase duration="{:.3f}" state="{}" minDur="{:.3f}" maxDur="{:.3f}")", phase.duration_s,
            phase.state, phase.min_s, phase.max_s);
    if (signal.type == "NEMA") {
        xml.add(R"( name="{}" vehext="{:.3f}" yellow="{:.3f}" red="{:.3f}")", escape_xml(phase.name), phase.extension_s,
                phase.yellow_s, phase.red_s);
    }
    if (!phase.next.empty()) xml.add(" next=\"{}\"", phase.next.front());
    xml.add("/>\n");
}

// Writes the signal programmes that Stopline uses, with the programID 'stopline'. SUMO applies them instead of the
// programmes in the network file, because it reads them last. Signals that react to traffic keep their type.
void write_lights(const std::filesystem::path& file, const SumoNetwork& network) {
    XmlFile xml(file, "additional", "additional_file.xsd");
    std::set<int> used_signals;
    for (const SumoLight& light : network.lights) used_signals.insert(light.signal);
    for (const int number : used_signals) {
        if (number < 0) continue;
        const SumoSignal& signal = network.net.signals[at(number)];
        xml.add("    <tlLogic id=\"{}\" type=\"{}\" programID=\"stopline\" offset=\"{:.3f}\">\n", escape_xml(signal.id),
                signal.controller == nullptr ? "static" : signal.type, signal.offset_s);
        if (signal.controller != nullptr) {
            for (const auto& [name, value] : signal.parameters)
                xml.add("        <param key=\"{}\" value=\"{}\"/>\n", escape_xml(name), escape_xml(value));
            for (const SumoPhase& phase : signal.controller->file_phases) write_controlled_phase(xml, signal, phase);
            xml.add("    </tlLogic>\n");
            continue;
        }
        for (const SumoPhase& phase : signal.phases) {
            if (phase.duration_s <= 0.0) continue;
            xml.add("        <phase duration=\"{:.3f}\" state=\"{}\"/>\n", phase.duration_s, phase.state);
        }
        xml.add("    </tlLogic>\n");
    }
    xml.finish();
}

void write_loops(const std::filesystem::path& file, const StopLineNames& lines) {
    XmlFile xml(file, "additional", "additional_file.xsd");
    for (const auto& [lane, name] : lines.stop_line_at_end) {
        const std::string id = escape_xml(lane);
        xml.add("    <instantInductionLoop id=\"{} stop_line\" lane=\"{}\" pos=\"-0.1\" file=\"detectors.out.xml\"/>\n",
                id, id);
    }
    xml.finish();
}

void write_configuration(const std::filesystem::path& file, const Model& model, const SumoNetwork& network,
                         double duration_s) {
    XmlFile xml(file, "sumoConfiguration", "sumoConfiguration.xsd");
    xml.add(
        "    <input>\n        <net-file value=\"{}\"/>\n        <route-files value=\"vehicles.rou.xml\"/>\n"
        "        <additional-files value=\"lights.add.xml,detectors.add.xml\"/>\n    </input>\n",
        escape_xml(network.net.file.generic_string()));
    xml.add("    <time>\n        <begin value=\"0\"/>\n        <end value=\"{:.1f}\"/>\n", duration_s);
    xml.add("        <step-length value=\"{:g}\"/>\n    </time>\n", model.step_s);
    write_sumo_rules(xml, model);
    xml.finish();
}

}  // namespace

StopLineNames stop_line_names(const SumoNetwork& network) {
    StopLineNames names;
    names.stop_line_of_lane.resize(network.graph.lanes.size());
    for (std::size_t edge = 0; edge < network.lane_of.size(); ++edge) {
        for (std::size_t k = 0; k < network.lane_of[edge].size(); ++k) {
            const int lane = network.lane_of[edge][k];
            if (lane < 0 || !has_signal(network.graph, network.graph.lanes[at(lane)])) continue;
            std::vector<std::string> end_lanes = network.net.edges[edge].lanes[k].end_lanes;
            if (end_lanes.empty()) end_lanes.push_back(network.graph.lanes[at(lane)].name);
            const auto shared = std::find_if(end_lanes.begin(), end_lanes.end(),
                                             [&](auto& end) { return names.stop_line_at_end.contains(end); });
            const std::string name =
                shared == end_lanes.end() ? network.graph.lanes[at(lane)].name : names.stop_line_at_end.at(*shared);
            names.stop_line_of_lane[at(lane)] = name;
            for (const std::string& end : end_lanes) names.stop_line_at_end.emplace(end, name);
        }
    }
    return names;
}

void write_imported_inputs(const std::filesystem::path& folder, const Model& model, const SumoNetwork& network,
                           const StopLineNames& lines, double duration_s) {
    write_imported_vehicles(folder / "vehicles.rou.xml", model, network);
    write_lights(folder / "lights.add.xml", network);
    write_loops(folder / "detectors.add.xml", lines);
    write_configuration(folder / "run.sumocfg", model, network, duration_s);
}

}  // namespace stopline

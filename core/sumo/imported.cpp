#include "sumo/imported.h"

#include <algorithm>
#include <set>

#include "sumo/imported_vehicles.h"
#include "sumo/inputs.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

bool has_light(const LaneGraph& graph, const Lane& lane) {
    if (lane.origin >= 0 || lane.signal_group < 0) return false;
    return lane.signal_group > 0 ||
           std::any_of(lane.next.begin(), lane.next.end(), [&](int way) { return graph.lanes[at(way)].light > 0; });
}

// Programmes as they run here: the last one of each id, as a static one. A name of its own makes SUMO take it for another one than
// the network's, and the one that was read last is used.
void write_lights(const std::filesystem::path& file, const SumoNetwork& network) {
    XmlFile xml(file, "additional", "additional_file.xsd");
    std::set<int> used;
    for (const SumoLight& light : network.lights) used.insert(light.signal);
    for (const int number : used) {
        if (number < 0) continue;
        const SumoSignal& signal = network.net.signals[at(number)];
        xml.add("    <tlLogic id=\"{}\" type=\"static\" programID=\"stopline\" offset=\"{:.3f}\">\n",
                xml_escaped(signal.id), signal.offset_s);
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
    for (const auto& [lane, name] : lines.of_ends) {
        const std::string id = xml_escaped(lane);
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
        xml_escaped(network.net.file.generic_string()));
    xml.add("    <time>\n        <begin value=\"0\"/>\n        <end value=\"{:.1f}\"/>\n", duration_s);
    xml.add("        <step-length value=\"{:g}\"/>\n    </time>\n", model.step_s);
    write_sumo_rules(xml, model);
    xml.finish();
}

}  // namespace

StopLineNames stop_line_names(const SumoNetwork& network) {
    StopLineNames names;
    names.of_lane.resize(network.graph.lanes.size());
    for (std::size_t edge = 0; edge < network.lane_of.size(); ++edge) {
        for (std::size_t k = 0; k < network.lane_of[edge].size(); ++k) {
            const int lane = network.lane_of[edge][k];
            if (lane < 0 || !has_light(network.graph, network.graph.lanes[at(lane)])) continue;
            std::vector<std::string> ends = network.net.edges[edge].lanes[k].ends;
            if (ends.empty()) ends.push_back(network.graph.lanes[at(lane)].name);
            const auto shared =
                std::find_if(ends.begin(), ends.end(), [&](auto& end) { return names.of_ends.contains(end); });
            const std::string name =
                shared == ends.end() ? network.graph.lanes[at(lane)].name : names.of_ends.at(*shared);
            names.of_lane[at(lane)] = name;
            for (const std::string& end : ends) names.of_ends.emplace(end, name);
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

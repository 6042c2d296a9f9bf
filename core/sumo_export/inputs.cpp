#include "sumo_export/inputs.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "base/io/escape.h"
#include "signals/signal_controller.h"

namespace stopline {

namespace {

std::string points_text(const Polyline& line) {
    std::string text;
    for (const Point& p : line) text += fmt::format("{}{:.3f},{:.3f}", text.empty() ? "" : " ", p.x_m, p.y_m);
    return text;
}

// Returns the shape of a lane between two positions on it.
Polyline lane_shape(const Lane& lane, double from_m, double to_m) {
    Polyline part;
    double along_m = 0.0;
    part.push_back(pose_at(lane.shape, lane.shape_start_m + from_m).point);
    for (std::size_t k = 1; k < lane.shape.size(); ++k) {
        along_m += length_m({lane.shape[k - 1], lane.shape[k]});
        if (along_m > lane.shape_start_m + from_m + 1e-6 && along_m < lane.shape_start_m + to_m - 1e-6) {
            part.push_back(lane.shape[k]);
        }
    }
    part.push_back(pose_at(lane.shape, lane.shape_start_m + to_m).point);
    return part;
}

void write_nodes(const std::filesystem::path& file, const PlainNetwork& network) {
    XmlFile xml(file, "nodes", "nodes_file.xsd");
    for (const PlainNode& node : network.nodes) {
        xml.add("    <node id=\"{}\" x=\"{:.3f}\" y=\"{:.3f}\" type=\"{}\"/>\n", node.id, node.position.x_m,
                node.position.y_m, node.has_signal ? "traffic_light" : "priority");
    }
    xml.finish();
}

void write_edges(const std::filesystem::path& file, const LaneGraph& graph, const PlainNetwork& network) {
    XmlFile xml(file, "edges", "edges_file.xsd");
    for (int number = 0; number < static_cast<int>(network.edges.size()); ++number) {
        const PlainEdge& edge = network.edges[at(number)];
        const auto shape_of = [&](int lane) {
            const double from_m = network.part_on(lane, number).from_m;
            return lane_shape(graph.lanes[at(lane)], from_m, from_m + edge.length_m);
        };
        const Lane& first = graph.lanes[at(edge.lanes[0])];
        Polyline centre_line = shape_of(edge.lanes[0]);
        const Polyline last = shape_of(edge.lanes.back());
        for (std::size_t k = 0; k < std::min(centre_line.size(), last.size()); ++k) {
            centre_line[k] = {0.5 * (centre_line[k].x_m + last[k].x_m), 0.5 * (centre_line[k].y_m + last[k].y_m)};
        }
        xml.add(
            "    <edge id=\"{}\" from=\"{}\" to=\"{}\" numLanes=\"{}\" speed=\"{:.6f}\" length=\"{:.3f}\" "
            "spreadType=\"center\" shape=\"{}\"/>\n",
            escape_xml(edge.id), network.nodes[at(edge.from)].id, network.nodes[at(edge.to)].id, edge.lanes.size(),
            first.limit_mps, edge.length_m, points_text(centre_line));
    }
    xml.finish();
}

void write_connections(const std::filesystem::path& file, const LaneGraph& graph, const PlainNetwork& network) {
    XmlFile xml(file, "connections", "connections_file.xsd");
    for (const PlainConnection& c : network.connections) {
        xml.add(R"(    <connection from="{}" to="{}" fromLane="{}" toLane="{}")",
                escape_xml(network.edges[at(c.begin.edge)].id), escape_xml(network.edges[at(c.end.edge)].id),
                c.begin.index, c.end.index);
        if (c.connection_lane >= 0) {
            const Lane& connection = graph.lanes[at(c.connection_lane)];
            xml.add(R"( speed="{:.6f}" length="{:.3f}" shape="{}")", connection.limit_mps, c.length_m,
                    points_text(connection.shape));
        } else if (c.length_m > 0.0) {
            xml.add(R"( length="{:.3f}")", c.length_m);
        }
        xml.add("/>\n");
    }
    xml.finish();
}

// Returns the signal group of a connection (lane index `connection`; -1: none) that begins on the lane `from`.
int signal_group_of(const LaneGraph& graph, int from, int connection) {
    const int own = connection < 0 ? -1 : graph.lanes[at(connection)].movement_signal_group;
    return own >= 0 ? own : graph.lanes[at(from)].signal_group;
}

// Returns true if a connection yields to the other connection of a conflict in the phase of the signal at `tick`.
bool yields_at(const Model& model, int connection, const Conflict& conflict, std::int64_t tick) {
    for (const PriorityByPhase& changing : model.priorities_by_phase) {
        const bool is_first = changing.first == connection && changing.second == conflict.other;
        const bool is_second = changing.second == connection && changing.first == conflict.other;
        if (!is_first && !is_second) continue;
        const int phase = model.signals[at(changing.signal)].phase_at.at(tick);
        if (phase < 0 || !changing.by_phase[at(phase)]) return false;
        const Priority priority = *changing.by_phase[at(phase)];
        return is_first ? priority.first_yields : priority.second_yields;
    }
    return conflict.yields;
}

// Returns SUMO's letter for the light of a connection at `tick`. 'G' is green with priority. 'g' is green for a
// connection that yields to another connection with green.
char link_state(const Model& model, const PlainConnection& c, std::int64_t tick) {
    const auto light_of = [&](int from, int connection) {
        return model.signals.programme(signal_group_of(model.graph, from, connection)).light(tick);
    };
    const Light light = light_of(c.from, c.connection_lane);
    if (light != Light::green) return light == Light::yellow ? 'y' : 'r';
    if (c.connection_lane < 0) return 'G';
    const std::vector<Conflict>& conflicts = model.graph.conflicts_of(c.connection_lane);
    const bool yields = std::any_of(conflicts.begin(), conflicts.end(), [&](const Conflict& conflict) {
        const int origin = model.graph.lanes[at(conflict.other)].origin;
        return origin >= 0 && model.graph.lanes[at(origin)].signal_group >= 0 &&
               light_of(origin, conflict.other) == Light::green && yields_at(model, c.connection_lane, conflict, tick);
    });
    return yields ? 'g' : 'G';
}

struct Phase {
    std::int64_t ticks = 0;
    std::string state;  // one letter (see link_state) for each link
};

// Returns the length of the programme to write, in ticks: one cycle if all signal groups repeat the same cycle during
// the whole run, else the length of the run.
std::int64_t programme_ticks(const Model& model, const std::vector<int>& groups, std::int64_t run_ticks) {
    const std::int64_t cycle = groups.empty() ? 0 : model.signals.programme(groups[0]).cycle_ticks();
    if (cycle <= 0 || cycle > run_ticks) return run_ticks;
    for (const int group : groups) {
        const GroupProgramme& programme = model.signals.programme(group);
        if (programme.cycle_ticks() != cycle) return run_ticks;
        for (std::int64_t tick = 0; tick + cycle < run_ticks; ++tick) {
            if (programme.light(tick) != programme.light(tick + cycle)) return run_ticks;
        }
    }
    return cycle;
}

std::vector<Phase> phases_of(const Model& model, const PlainNetwork& network, int node, std::int64_t run_ticks) {
    std::vector<const PlainConnection*> links;
    std::vector<int> groups;
    for (const PlainConnection& c : network.connections) {
        if (c.node != node || c.link < 0) continue;
        links.push_back(&c);
        groups.push_back(signal_group_of(model.graph, c.from, c.connection_lane));
    }
    std::vector<Phase> phases;
    const std::int64_t ticks = programme_ticks(model, groups, run_ticks);
    std::vector<Light> previous_lights;
    int previous_phase = -1;
    const Timeline<int>* const phase_at = groups.empty() ? nullptr : &model.signals.plan_of(groups[0]).phase_at;
    for (std::int64_t tick = 0; tick < ticks; ++tick) {
        std::vector<Light> lights;
        for (const int group : groups) lights.push_back(model.signals.programme(group).light(tick));
        // Right of way can change between phases although the lights stay the same.
        const int phase = phase_at == nullptr || phase_at->empty() ? -1 : phase_at->at(tick);
        if (lights != previous_lights || phase != previous_phase) {
            std::string text;
            for (const PlainConnection* const c : links) text += link_state(model, *c, tick);
            phases.push_back({0, text});
            previous_lights = lights;
            previous_phase = phase;
        }
        ++phases.back().ticks;
    }
    return phases;
}

// Throws InputError if a signal reacts to traffic: its lights are not known before the run.
void write_lights(const std::filesystem::path& file, const Model& model, const PlainNetwork& network,
                  double duration_s) {
    for (const SignalPlan& plan : model.signals) {
        if (plan.controller->follows_programme) continue;
        std::vector<std::string> exportable;
        for (const SignalController* controller : signal_controllers()) {
            if (controller->follows_programme) exportable.emplace_back(controller->name);
        }
        throw InputError(
            fmt::format("field 'signal.controller': value '{}' reacts to traffic, so there is no programme to export; "
                        "controllers that can be exported: {}",
                        plan.controller->name, fmt::join(exportable, ", ")));
    }
    XmlFile xml(file, "tlLogics", "tllogic_file.xsd");
    const std::int64_t run_ticks = std::max<std::int64_t>(to_ticks(duration_s, model.step_s), 1);
    for (int node = 0; node < static_cast<int>(network.nodes.size()); ++node) {
        if (!network.nodes[at(node)].has_signal) continue;
        xml.add("    <tlLogic id=\"{}\" type=\"static\" programID=\"0\" offset=\"0\">\n", network.nodes[at(node)].id);
        for (const Phase& phase : phases_of(model, network, node, run_ticks)) {
            xml.add("        <phase duration=\"{:.2f}\" state=\"{}\"/>\n", model.time_s(phase.ticks), phase.state);
        }
        xml.add("    </tlLogic>\n");
    }
    for (const PlainConnection& c : network.connections) {
        if (c.link < 0) continue;
        xml.add("    <connection from=\"{}\" to=\"{}\" fromLane=\"{}\" toLane=\"{}\" tl=\"{}\" linkIndex=\"{}\"/>\n",
                escape_xml(network.edges[at(c.begin.edge)].id), escape_xml(network.edges[at(c.end.edge)].id),
                c.begin.index, c.end.index, network.nodes[at(c.node)].id, c.link);
    }
    xml.finish();
}

// Writes an induction loop for each stop line, and the induction loops of the scenario.
void write_detectors(const std::filesystem::path& file, const Model& model, const PlainNetwork& network) {
    constexpr double kPeriod_s = 60.0;  // default of --e1-interval
    XmlFile xml(file, "additional", "additional_file.xsd");
    for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
        if (model.graph.lanes[at(lane)].signal_group < 0) continue;
        const std::string id = escape_xml(network.lane_id(lane));
        xml.add("    <instantInductionLoop id=\"{} stop_line\" lane=\"{}\" pos=\"-0.1\" file=\"detectors.out.xml\"/>\n",
                id, id);
    }
    for (const Detector& detector : model.detectors) {
        if (detector.kind != Detector::Kind::loop) continue;
        const EdgePart& part = network.part_at(detector.lane, detector.position_m);
        xml.add(
            "    <inductionLoop id=\"{}\" lane=\"{}\" pos=\"{:.3f}\" friendlyPos=\"true\" period=\"{:.0f}\" "
            "file=\"loops.out.xml\"/>\n",
            escape_xml(model.loop_names[at(detector.loop)]), escape_xml(network.lane_id(part)),
            detector.position_m - part.from_m, kPeriod_s);
    }
    xml.finish();
}

void write_configuration(const std::filesystem::path& file, const Model& model, double duration_s) {
    constexpr double kStep_s = 0.1;  // time step of the mesoscale mode
    XmlFile xml(file, "sumoConfiguration", "sumoConfiguration.xsd");
    xml.add(
        "    <input>\n        <net-file value=\"net.net.xml\"/>\n        <route-files value=\"vehicles.rou.xml\"/>\n"
        "        <additional-files value=\"detectors.add.xml\"/>\n    </input>\n");
    xml.add("    <time>\n        <begin value=\"0\"/>\n        <end value=\"{:.1f}\"/>\n", duration_s);
    xml.add("        <step-length value=\"{:.1f}\"/>\n    </time>\n", kStep_s);
    write_sumo_rules(xml, model);
    xml.finish();
}

}  // namespace

void write_sumo_inputs(const std::filesystem::path& folder, const Model& model, const PlainNetwork& network,
                       double duration_s) {
    write_nodes(folder / "nodes.nod.xml", network);
    write_edges(folder / "edges.edg.xml", model.graph, network);
    write_connections(folder / "connections.con.xml", model.graph, network);
    write_lights(folder / "lights.tll.xml", model, network, duration_s);
    write_detectors(folder / "detectors.add.xml", model, network);
    write_configuration(folder / "run.sumocfg", model, duration_s);
}

void write_sumo_rules(XmlFile& xml, const Model& model) {
    const RulesPlan& rules = model.rules;
    xml.add("    <processing>\n        <time-to-teleport value=\"{:g}\"/>\n",
            rules.teleport_ticks > 0 ? model.time_s(rules.teleport_ticks) : -1.0);
    xml.add("        <ignore-junction-blocker value=\"{:g}\"/>\n",
            rules.pass_blocker_ticks > 0 ? model.time_s(rules.pass_blocker_ticks) : -1.0);
    xml.add("        <collision.action value=\"warn\"/>\n    </processing>\n");
}

}  // namespace stopline

// Tests that signals with phases keep their lights and their right of way through export and import.
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>

#include "base/containers/index.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "scenario/scenario_text.h"
#include "sumo_export/edges.h"
#include "sumo_export/export.h"
#include "sumo_export/inputs.h"
#include "sumo_import/sumo_graph.h"
#include "sumo_import/sumo_net.h"
#include "sumo_import/sumo_signals.h"

namespace stopline {
namespace {

constexpr double kRun_s = 400.0;

Model model_of(const std::string& signal) {
    return build_model(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                                     {"network.grid={columns: 2, rows: 1}", "duration=400 s", "measure.window=200 s",
                                      "signal=" + signal}),
                       0);
}

// A leading left turn of one side, then both sides with permissive left turns, then pedestrians, then the cross street.
std::string phases() {
    return "[{protected: [west_left, west_straight, west_right], green: 8 s, yellow: 3 s, all_red: 1 s}, {protected: "
           "[west_straight, east_straight], permissive: [west_left, east_left, west_right, east_right], green: 15 s}, "
           "{green: 6 s}, {protected: [south_straight, north_straight], permissive: [south_left, north_left, south_right, "
           "north_right], green: 15 s}]";
}

using Link = std::pair<std::string, std::string>;  // SUMO names of the lanes at the ends of a connection

int signal_group_of(const LaneGraph& graph, int connection) {
    const Lane& lane = graph.lanes[at(connection)];
    return lane.movement_signal_group >= 0 ? lane.movement_signal_group : graph.lanes[at(lane.origin)].signal_group;
}

struct Imported {
    SumoNetwork network;
    SignalPlans signals;
    std::map<Link, int> connections;  // lane index of each connection
};

Imported exported_and_imported(const Model& model, const PlainNetwork& network) {
    const TemporaryFolder folder;
    write_sumo_inputs(folder.path(), model, network, kRun_s);
    make_net_file(folder.path());
    Imported imported{make_sumo_network(read_sumo_net(folder.path() / "net.net.xml"), 2.0), {}, {}};
    imported.signals = make_sumo_signals(imported.network, model.step_s);
    const LaneGraph& graph = imported.network.graph;
    for (int lane = 0; lane < static_cast<int>(graph.lanes.size()); ++lane) {
        const Lane& connection = graph.lanes[at(lane)];
        if (connection.origin < 0) continue;
        imported.connections[{graph.lanes[at(connection.origin)].name, graph.lanes[at(connection.next[0])].name}] =
            lane;
    }
    return imported;
}

void expect_same_lights(const std::string& signal) {
    const Model model = model_of(signal);
    const PlainNetwork network = plain_network(model.graph);
    const Imported imported = exported_and_imported(model, network);
    int greens = 0;
    for (const PlainConnection& c : network.connections) {
        if (c.connection_lane < 0) continue;
        const auto found = imported.connections.find({network.lane_id(c.begin), network.lane_id(c.end)});
        ASSERT_NE(found, imported.connections.end()) << network.lane_id(c.begin);
        const GroupProgramme& own = model.signals.programme(signal_group_of(model.graph, c.connection_lane));
        const GroupProgramme& other =
            imported.signals.programme(signal_group_of(imported.network.graph, found->second));
        for (std::int64_t tick = 0; tick < to_ticks(kRun_s, model.step_s); ++tick) {
            ASSERT_EQ(own.light(tick), other.light(tick)) << network.lane_id(c.begin) << " at tick " << tick;
            greens += own.light(tick) == Light::green ? 1 : 0;
        }
    }
    EXPECT_GT(greens, 10'000);
}

TEST(ExportedPhases, KeepTheirLights) {
    if (!has_sumo()) GTEST_SKIP() << "SUMO is not installed";
    expect_same_lights("{first_green: 2 s, offset: 7 s, phases: " + phases() + "}");
}

TEST(ExportedPhases, KeepTheLightsOfSeveralProgrammes) {
    if (!has_sumo()) GTEST_SKIP() << "SUMO is not installed";
    expect_same_lights(
        "{first_green: 0 s, clock: 7 h, programmes: [{from: 0 h, phases: " + phases() +
        "}, {from: 7.03 h, phases: [{protected: [west_straight, east_straight, west_right], permissive: "
        "[west_left, east_left, east_right], green: 15 s}, {protected: [south_straight, north_straight], "
        "permissive: [south_left, north_left, south_right, north_right], green: 25 s}]}]}");
}

// In each phase in which two conflicting connections have green, the same one yields.
TEST(ExportedPhases, KeepTheirRightOfWay) {
    if (!has_sumo()) GTEST_SKIP() << "SUMO is not installed";
    // In the first phase the left turn from the west goes first, in the second one the traffic from the east.
    const std::string phases =
        "[{protected: [west_left, west_straight, west_right], permissive: [east_straight], green: 8 s}, {protected: "
        "[west_straight, east_straight], permissive: [west_left, east_left, west_right, east_right], green: 15 s}, "
        "{protected: [south_straight, north_straight], permissive: [south_left, north_left, south_right, north_right], "
        "green: 15 s}]";
    const Model model = model_of("{first_green: 2 s, phases: " + phases + "}");
    ASSERT_FALSE(model.priorities_by_phase.empty());
    const PlainNetwork network = plain_network(model.graph);
    const Imported imported = exported_and_imported(model, network);
    const std::vector<PhasePriority> changing = make_sumo_phase_priorities(imported.network, model.step_s);
    std::map<int, int> imported_lane;
    for (const PlainConnection& c : network.connections) {
        if (c.connection_lane >= 0) {
            imported_lane[c.connection_lane] =
                imported.connections.at({network.lane_id(c.begin), network.lane_id(c.end)});
        }
    }
    int checked = 0;
    for (const PriorityByPhase& own : model.priorities_by_phase) {
        const int first = imported_lane.at(own.first);
        const int second = imported_lane.at(own.second);
        const auto same = [&](const PhasePriority& p) {
            return (p.first() == first && p.second() == second) || (p.first() == second && p.second() == first);
        };
        const auto found = std::find_if(changing.begin(), changing.end(), same);
        ASSERT_NE(found, changing.end());
        const Timeline<int>& phase_at = model.signals[at(own.signal)].phase_at;
        for (std::int64_t tick = 20; tick < to_ticks(200.0, model.step_s); ++tick) {
            const std::optional<Priority>& expected = own.by_phase[at(phase_at.at(tick))];
            const bool begins = phase_at.start_tick(tick) == tick;
            if (!expected || !begins) continue;
            const Priority priority = found->at(tick);
            EXPECT_EQ(found->first() == first ? priority.first_yields : priority.second_yields, expected->first_yields);
            EXPECT_EQ(found->first() == first ? priority.second_yields : priority.first_yields,
                      expected->second_yields);
            ++checked;
        }
    }
    EXPECT_GT(checked, 20);
}

}  // namespace
}  // namespace stopline

// Networks that were exported, and read again as netconvert made them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/containers/index.h"
#include "scenario/build_model.h"
#include "sumo_import/sumo_graph.h"
#include "sumo_import/sumo_net.h"
#include "scenario/load_scenario.h"
#include "scenario/scenario_text.h"
#include "sumo_export/edges.h"
#include "sumo_export/export.h"
#include "sumo_export/inputs.h"

namespace stopline {
namespace {

constexpr double kClearance_m = 2.0;  // the default of imported networks

// By the names in SUMO of the lanes that a way leads from and to.
using WayName = std::pair<std::string, std::string>;
// Each pair of ways that meet, from both sides: who gives way, and where on the first of them they meet.
struct Meeting {
    bool yields = false;
    bool other_yields = false;
    double from_m = 0.0;  // from the stop line
    double to_m = 0.0;
};
using Meetings = std::map<std::pair<WayName, WayName>, Meeting>;

template <class NameOfLane>
Meetings meetings_of(const LaneGraph& graph, const NameOfLane& name_of) {
    const auto way_name = [&](int way) {
        const Lane& lane = graph.lanes[at(way)];
        return WayName{name_of(lane.origin), name_of(lane.next.front())};
    };
    Meetings meetings;
    for (int way = 0; way < static_cast<int>(graph.lanes.size()); ++way) {
        if (graph.lanes[at(way)].origin < 0) continue;
        const Lane& origin = graph.lanes[at(graph.lanes[at(way)].origin)];
        const double shared_m = origin.length_m - origin.stop_line_m;
        for (const Conflict& c : graph.conflicts_of(way)) {
            meetings[{way_name(way), way_name(c.other)}] = {c.yields, c.other_yields, shared_m + c.from_m,
                                                            shared_m + c.to_m};
        }
    }
    return meetings;
}

class RoundTrip : public ::testing::TestWithParam<std::pair<const char*, std::size_t>> {};

TEST_P(RoundTrip, KeepsConflictsAndWhoGivesWay) {
    if (!has_sumo()) GTEST_SKIP() << "SUMO is not installed";
    const auto& [name, conflicts] = GetParam();
    std::vector<std::string> overrides{"fidelity=meso"};
    if (name == std::string("grid"))
        overrides.insert(overrides.end(), {"network.grid.columns=3", "network.grid.rows=2"});
    const Model model =
        build_model(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/" + std::string(name) + ".yaml", overrides), 0);
    const PlainNetwork network = plain_network(model.graph);
    const TemporaryFolder folder;
    write_sumo_inputs(folder.path(), model, network, 100.0);
    make_net_file(folder.path());
    const SumoNetwork made = make_sumo_network(read_sumo_net(folder.path() / "net.net.xml"), kClearance_m);

    const Meetings before = meetings_of(model.graph, [&](int lane) { return network.lane_id(lane); });
    const Meetings after = meetings_of(made.graph, [&](int lane) { return made.graph.lanes[at(lane)].name; });
    EXPECT_EQ(before.size(), conflicts);
    EXPECT_EQ(after.size(), conflicts);
    double farthest_m = 0.0;
    for (const auto& [pair, meeting] : before) {
        const auto found = after.find(pair);
        ASSERT_NE(found, after.end()) << pair.first.first << " to " << pair.first.second;
        EXPECT_EQ(found->second.yields, meeting.yields) << pair.first.first << " to " << pair.first.second;
        EXPECT_EQ(found->second.other_yields, meeting.other_yields) << pair.first.first << " to " << pair.first.second;
        farthest_m = std::max(
            {farthest_m, std::abs(found->second.from_m - meeting.from_m), std::abs(found->second.to_m - meeting.to_m)});
    }
    RecordProperty("farthest_m", std::to_string(farthest_m));
    EXPECT_LT(farthest_m, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Networks, RoundTrip,
                         ::testing::Values(std::pair{"intersection", 88U}, std::pair{"arterial", 440U},
                                           std::pair{"grid", 528U}));

}  // namespace
}  // namespace stopline

// Tests that an exported network, built by netconvert and imported again, has the conflicts of the original.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/containers/index.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "scenario/scenario_text.h"
#include "sumo_export/edges.h"
#include "sumo_export/export.h"
#include "sumo_export/inputs.h"
#include "sumo_import/sumo_graph.h"
#include "sumo_import/sumo_net.h"

namespace stopline {
namespace {

constexpr double kClearance_m = 2.0;  // the default of imported networks

// A connection, named by the SUMO names of the lanes at its ends.
using ConnectionName = std::pair<std::string, std::string>;
// A conflict of two connections as seen from the first one: the yielding sides and the conflict area.
struct ConflictView {
    bool yields = false;
    bool other_yields = false;
    double from_m = 0.0;  // distance from the stop line
    double to_m = 0.0;
};
using ConflictViews = std::map<std::pair<ConnectionName, ConnectionName>, ConflictView>;

// A lane of the graph can consist of several SUMO lanes, one behind the other. `name_of_end` returns the SUMO name of
// the last one, `name_of_start` that of the first one.
template <class NameOfLane>
ConflictViews conflicts_of_graph(const LaneGraph& graph, const NameOfLane& name_of_end,
                                 const NameOfLane& name_of_start) {
    const auto connection_name = [&](int connection) {
        const Lane& lane = graph.lanes[at(connection)];
        return ConnectionName{name_of_end(lane.origin), name_of_start(lane.next.front())};
    };
    ConflictViews views;
    for (int connection = 0; connection < static_cast<int>(graph.lanes.size()); ++connection) {
        if (graph.lanes[at(connection)].origin < 0) continue;
        const Lane& origin = graph.lanes[at(graph.lanes[at(connection)].origin)];
        const double shared_m = origin.length_m - origin.stop_line_m;
        for (const Conflict& c : graph.conflicts_of(connection)) {
            views[{connection_name(connection), connection_name(c.other)}] = {c.yields, c.other_yields,
                                                                              shared_m + c.from_m, shared_m + c.to_m};
        }
    }
    return views;
}

class RoundTrip : public ::testing::TestWithParam<std::pair<const char*, std::size_t>> {};

TEST_P(RoundTrip, KeepsConflictsAndRightOfWay) {
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
    const SumoNetwork imported_network = make_sumo_network(read_sumo_net(folder.path() / "net.net.xml"), kClearance_m);

    using NameOfLane = std::function<std::string(int)>;
    const ConflictViews original = conflicts_of_graph<NameOfLane>(
        model.graph, [&](int lane) { return network.lane_id(network.parts_of[at(lane)].back()); },
        [&](int lane) { return network.lane_id(network.parts_of[at(lane)].front()); });
    const NameOfLane own_name = [&](int lane) { return imported_network.graph.lanes[at(lane)].name; };
    const ConflictViews imported = conflicts_of_graph(imported_network.graph, own_name, own_name);
    EXPECT_EQ(original.size(), conflicts);
    EXPECT_EQ(imported.size(), conflicts);
    double largest_shift_m = 0.0;
    for (const auto& [pair, view] : original) {
        const auto found = imported.find(pair);
        ASSERT_NE(found, imported.end()) << pair.first.first << " to " << pair.first.second;
        EXPECT_EQ(found->second.yields, view.yields) << pair.first.first << " to " << pair.first.second;
        EXPECT_EQ(found->second.other_yields, view.other_yields) << pair.first.first << " to " << pair.first.second;
        largest_shift_m = std::max(
            {largest_shift_m, std::abs(found->second.from_m - view.from_m), std::abs(found->second.to_m - view.to_m)});
    }
    RecordProperty("largest_shift_m", std::to_string(largest_shift_m));
    EXPECT_LT(largest_shift_m, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Networks, RoundTrip,
                         ::testing::Values(std::pair{"intersection", 88U}, std::pair{"arterial", 440U},
                                           std::pair{"grid", 528U}, std::pair{"berlin", 632U}));

}  // namespace
}  // namespace stopline

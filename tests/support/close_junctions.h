// Helpers for tests of close junctions in imported networks.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "sim/state/model.h"
#include "support/sumo_files.h"

namespace stopline::testing {

// Returns `net` with a signal at its priority junction K: green for internal lane :K_0_0, then for :K_1_0, for 20 s
// each.
inline std::string with_signal_at_k(const std::string& net) {
    std::string text = replaced(net, R"(<junction id="K" type="priority")",
                                R"(<tlLogic id="K" type="static" programID="0" offset="0">
<phase duration="20" state="Gr"/><phase duration="4" state="yr"/>
<phase duration="20" state="rG"/><phase duration="4" state="ry"/></tlLogic>
<junction id="K" type="traffic_light")");
    text = replaced(text, R"(via=":K_0_0" dir)", R"(via=":K_0_0" tl="K" linkIndex="0" dir)");
    return replaced(text, R"(via=":K_1_0" dir)", R"(via=":K_1_0" tl="K" linkIndex="1" dir)");
}

// Returns a flow of vehicles of type x from the start of a run until `end_s`.
inline std::string flow(const std::string& from, const std::string& to, int rate_vehph, int end_s) {
    return "<flow id=\"" + from + R"(" type="x" from=")" + from + R"(" to=")" + to + R"(" begin="0" end=")" +
           std::to_string(end_s) + R"(" departSpeed="max" vehsPerHour=")" + std::to_string(rate_vehph) + "\"/>\n";
}

// Returns the index of the lane with this name. Fails the test if there is none.
inline int lane_named(const Model& model, const std::string& name) {
    const auto& lanes = model.graph.lanes;
    const auto found = std::find_if(lanes.begin(), lanes.end(), [&](const Lane& lane) { return lane.name == name; });
    EXPECT_NE(found, lanes.end()) << name;
    return static_cast<int>(found - lanes.begin());
}

}  // namespace stopline::testing

// Which detectors are covered. A vehicle covers a detector from the passage of its front to that of its rear, even if
// its front is on a later lane by then.
#include "sim/state/queries/covered_detector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "base/containers/index.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

// The lanes of a vehicle so far, and the distance from the start of each lane to the start of the present lane.
struct Path {
    struct Start {
        int lane = -1;
        double before_m = 0.0;
    };
    std::vector<Start> starts;
    double length_m = 0.0;  // of the vehicle
    double position_m = 0.0;

    bool covers(int lane, double line_m) const {
        return std::any_of(starts.begin(), starts.end(), [&](const Start& start) {
            const double front_m = start.before_m + position_m;
            return start.lane == lane && front_m >= line_m && front_m - length_m < line_m;
        });
    }
};

// Follows all vehicles of a run without lane changes.
class Paths {
public:
    explicit Paths(const Model& model) : model_(model) {}

    void update(const State& state) {
        present_.clear();
        const VehicleArrays& v = state.vehicles;
        for (int lane = 0; lane < static_cast<int>(state.blocks.size()); ++lane) {
            const LaneBlock& block = state.blocks[at(lane)];
            for (int slot = block.first; slot < block.past_last(); ++slot) {
                Path& path = paths_[v.id[at(slot)]];
                enter(path, lane);
                path.length_m = static_cast<double>(v.length_m[at(slot)]);
                path.position_m = v.position_m[at(slot)];
                present_.push_back(&path);
            }
        }
    }

    bool covers(int lane, double line_m) const {
        return std::any_of(present_.begin(), present_.end(), [&](const Path* p) { return p->covers(lane, line_m); });
    }
    // Returns true if a vehicle covers the position although its front is on the second lane further on.
    bool covers_over_two_lanes(int lane, double line_m) const {
        return std::any_of(present_.begin(), present_.end(), [&](const Path* path) {
            const std::size_t lanes = path->starts.size();
            return lanes >= 3 && path->starts[lanes - 3].lane == lane && path->covers(lane, line_m);
        });
    }

private:
    void enter(Path& path, int lane) {
        if (path.starts.empty()) path.starts.push_back({lane, 0.0});
        const int last = path.starts.back().lane;
        if (last == lane) return;
        const std::vector<int>& next = model_.graph.lanes[at(last)].next;
        if (std::find(next.begin(), next.end(), lane) == next.end()) {
            // The vehicle has passed over a whole lane within the step.
            const auto between = std::find_if(next.begin(), next.end(), [&](int one) {
                const std::vector<int>& second = model_.graph.lanes[at(one)].next;
                return std::find(second.begin(), second.end(), lane) != second.end();
            });
            ASSERT_NE(between, next.end()) << "the vehicle has changed lanes";
            enter(path, *between);
            return enter(path, lane);
        }
        const double length_m = model_.graph.lanes[at(last)].length_m;
        for (Path::Start& start : path.starts) start.before_m += length_m;
        path.starts.push_back({lane, 0.0});
    }

    const Model& model_;
    std::map<int, Path> paths_;  // [vehicle]
    std::vector<const Path*> present_;
};

// Steps with a covered detector.
struct Covered {
    int steps = 0;
    int over_two_lanes = 0;
};

// Compares is_covered() with the paths of the vehicles, for all detectors and steps.
Covered compare(const std::string& file, const std::vector<std::string>& overrides, double end_s) {
    const Model model = build_model(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/" + file, overrides), 0);
    Simulation simulation(model);
    Paths paths(model);
    Covered covered;
    while (simulation.time_s() < end_s) {
        simulation.step();
        paths.update(simulation.state());
        for (std::size_t k = 0; k < model.detectors.size(); ++k) {
            const Detector& detector = model.detectors[k];
            if (detector.lane < 0) continue;
            const bool expected = paths.covers(detector.lane, detector.position_m);
            covered.steps += expected ? 1 : 0;
            covered.over_two_lanes += paths.covers_over_two_lanes(detector.lane, detector.position_m) ? 1 : 0;
            EXPECT_EQ(is_covered(model, simulation.state(), k), expected)
                << model.graph.lanes[at(detector.lane)].name << " at " << detector.position_m << " m, "
                << simulation.time_s() << " s";
        }
        if (::testing::Test::HasFailure()) break;
    }
    return covered;
}

class CoveredDetectors : public ::testing::TestWithParam<const char*> {
protected:
    std::string fidelity() const { return std::string("fidelity=") + GetParam(); }
};
INSTANTIATE_TEST_SUITE_P(Fidelities, CoveredDetectors, ::testing::Values("meso", "full"));

TEST_P(CoveredDetectors, AtASingleLight) {
    const Covered covered = compare("first_steps.yaml", {fidelity(), "network.approach.lanes=2"}, 120.0);
    EXPECT_GT(covered.steps, 50);
}

// Exit lanes get vehicles from several connections. Right turns are shorter than lorries.
TEST_P(CoveredDetectors, AtAnIntersectionWithLorries) {
    const Covered covered =
        compare("intersection.yaml",
                {fidelity(), "duration=100 s", "vehicle=articulated_lorry_35t", "demand.left=20 %", "demand.right=40 %",
                 "network.intersection.lanes=[{movements: straight+left+right}]", "network.intersection.radius=8 m",
                 "measure.cycles=1"},
                100.0);
    EXPECT_GT(covered.steps, 200);
    EXPECT_GT(covered.over_two_lanes, 20);
}

}  // namespace
}  // namespace stopline

// Cooperative gap opening. Lane k of the approach has index 2 k, and its exit lane has index 2 k + 1.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "base/containers/index.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/lane_change/route_choice.h"
#include "sim/state/queries/desired_gap.h"
#include "sim/step/simulation.h"
#include "support/track.h"
#include "v2v/channel.h"

namespace stopline {
namespace {

using testing_support::Track;
using testing_support::TrackPlan;

constexpr double kLength_m = 5.15;
constexpr double kSpacing_m = 8.1;  // vehicle and gap of 2.95 m

// Returns a road with two lanes. The left lane is for left turns, the right lane for straight traffic.
Model two_lanes(const std::string& fidelity, const std::string& gap_opening, double green_from_s = 0.0,
                const std::vector<std::string>& overrides = {}, double limit_mps = 50.0 / 3.6) {
    TrackPlan plan;
    plan.policy = "CDG";
    plan.lanes = 2;
    plan.length_m = 1000.0;
    plan.green_from_s = green_from_s;
    plan.limit_mps = limit_mps;
    plan.overrides = {"fidelity=" + fidelity, "driver.lane_change.gap_opening=" + gap_opening,
                      "driver.lane_change.look_ahead_time=60 s", "driver.lane_change.threshold=10 m/s2"};
    plan.overrides.insert(plan.overrides.end(), overrides.begin(), overrides.end());
    Model model = build_model(testing_support::scenario_of(plan), 0);
    LaneGraph& graph = model.graph;
    graph.lanes[0].right = 2;
    graph.lanes[2].left = 0;
    graph.lanes[0].approach = graph.lanes[2].approach = 0;
    graph.lanes[1].turn = Turn::left;
    graph.lanes[3].turn = Turn::straight;
    graph.approaches = {Approach{"approach", {0, 2}, 0.0, 0.0}};
    model.demand.inlets.clear();
    return model;
}

// Places a vehicle on lane k. Its route requires lane `target` at the stop line. Returns its id.
int place(Track& track, int k, double position_m, double speed_mps, int target) {
    const int id = track.place(2 * k, position_m, speed_mps);
    State& state = track.mutable_state();
    const int slot = state.blocks[at(2 * k)].last();
    state.vehicles.record[at(slot)].route = target;
    adopt_lane_route(track.model(), state, 2 * k, slot);
    return id;
}

void place_platoon(Track& track, double first_m, double speed_mps, int vehicles) {
    for (int k = 0; k < vehicles; ++k) place(track, 0, first_m - k * kSpacing_m, speed_mps, 0);
}

bool is_on(const State& state, int lane, int id) {
    const LaneBlock& block = state.blocks[at(lane)];
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        if (state.vehicles.id[at(slot)] == id) return true;
    }
    return false;
}

class GapCooperationTest : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Fidelities, GapCooperationTest, testing::Values("meso", "full"),
                         [](const auto& run) { return std::string(run.param); });

// A requester drives beside the second of two vehicles at constant speed. The requester accepts no gap, because it
// requires twice the gap of the policy.
class TwoVehiclesAndRequester {
public:
    static constexpr double kLimit_mps = 12.0;

    explicit TwoVehiclesAndRequester(const std::string& fidelity)
        : track_(two_lanes(fidelity, "cooperative", 0.0,
                           {"driver.lane_change.gap_share=200 %", "driver.lane_change.urgent_gap_share=200 %"},
                           kLimit_mps)) {
        const double speed_mps = this->speed_mps();
        const double gap_m = desired_gap_m(track_.model(), 0, speed_mps);
        place(track_, 0, 300.0, speed_mps, 0);
        place(track_, 0, 300.0 - kLength_m - gap_m, speed_mps, 0);
        track_.make_follower(0, 1);
        requester_ = place(track_, 1, 300.0 - kLength_m - gap_m, speed_mps, 0);
    }

    Track& track() { return track_; }
    double speed_mps() const { return track_.state().plan.free_speed_mps(0); }
    int requester() const { return requester_; }
    const GapCounts& counts() const { return track_.state().records.gap_counts; }
    const std::vector<GapRequest>& requests() const { return track_.state().gap_cooperation.requests[2]; }

private:
    Track track_;
    int requester_ = -1;
};

// The gap grows by the length D: the requester's length plus two gaps of the policy, minus the present gap, plus
// GapRequest::extra_m. With a speed difference of 1.5 m/s and ramps of 1 m/s2 this takes D / 1.5 + 1.5 / 1.
TEST_P(GapCooperationTest, GapOpensInTheTimeOfTheClosedForm) {
    TwoVehiclesAndRequester run(GetParam());
    Track& track = run.track();
    const double room_m = kLength_m + 2.0 * desired_gap_m(track.model(), 0, run.speed_mps());
    double begun_s = -1.0;
    double begin_gap_m = 0.0;
    double missing_m = 0.0;
    double opened_s = -1.0;
    double lowest_mps = 1e3;
    for (double t = 0.1; t < 14.0 && opened_s < 0.0; t += 0.1) {
        track.run(0.1);
        const double gap_m = track.vehicle(0, 1).gap_m;
        if (begun_s < 0.0 && !run.requests().empty() && run.requests()[0].begin_tick >= 0) {
            begun_s = track.time_s();
            begin_gap_m = gap_m;
            missing_m = room_m - gap_m + run.requests()[0].extra_m;
        }
        lowest_mps = std::min(lowest_mps, track.vehicle(0, 1).speed_mps - track.vehicle(0, 0).speed_mps);
        if (begun_s >= 0.0 && gap_m >= begin_gap_m + missing_m - 0.05) opened_s = track.time_s();
    }
    ASSERT_GE(begun_s, 0.0);
    ASSERT_GE(opened_s, 0.0);
    EXPECT_FALSE(is_on(track.state(), 0, run.requester()));
    EXPECT_EQ(run.counts().agreed, 1);
    EXPECT_NEAR(missing_m, kSpacing_m, 1.0);
    EXPECT_NEAR(opened_s - begun_s, missing_m / 1.5 + 1.5 / 1.0, 0.5);
    EXPECT_NEAR(lowest_mps, -1.5, 0.2);
}

// The requester accepts no gap. The agreement ends after 10 s, and the opener closes up again.
TEST_P(GapCooperationTest, AgreementEndsAfterTheTimeLimit) {
    TwoVehiclesAndRequester run(GetParam());
    Track& track = run.track();
    double begun_s = -1.0;
    double ended_s = -1.0;
    for (double t = 0.1; t < 14.0 && ended_s < 0.0; t += 0.1) {
        track.run(0.1);
        const bool agreed = !run.requests().empty() && run.requests()[0].opener >= 0;
        if (begun_s < 0.0 && agreed) begun_s = track.time_s();
        if (begun_s >= 0.0 && !agreed) ended_s = track.time_s();
    }
    ASSERT_GE(begun_s, 0.0) << "no agreement";
    ASSERT_GE(ended_s, 0.0);
    EXPECT_EQ(run.counts().opened, 1);
    EXPECT_EQ(run.counts().of(GapEnding::expired), 1);
    EXPECT_NEAR(ended_s - begun_s, 10.0, 0.3);
    const double gap_m = track.vehicle(0, 1).gap_m;
    track.run(4.9);  // the requester pauses for 5 s
    EXPECT_LT(track.vehicle(0, 1).gap_m, gap_m + 0.5);
    EXPECT_GT(track.vehicle(0, 1).speed_mps, track.vehicle(0, 0).speed_mps + 0.3);
}

// A channel that delivers the first 30 messages of each vehicle. These are the messages of the first three seconds.
bool is_early(const V2vSettings& /*settings*/, const V2vMessage& message) { return message.number < 30; }
constexpr V2vChannel kBreaksDown{"breaks_down", "delivers the first 30 messages", {}, false, is_early, nullptr};
// The list of channels must be complete before the first scenario is loaded.
[[maybe_unused]] const bool kIsRegistered = (register_v2v_channel(kBreaksDown), true);

// An agreement ends after a second without messages. Without messages the vehicles make no new agreement.
TEST_P(GapCooperationTest, LostMessagesEndTheAgreement) {
    // The requester accepts no gap, so that the agreement does not end otherwise.
    Track track(two_lanes(GetParam(), "cooperative", 0.0,
                          {"driver.v2v={channel: breaks_down, interval: 100 ms}", "driver.lane_change.gap_share=200 %",
                           "driver.lane_change.urgent_gap_share=200 %"},
                          10.0));
    place_platoon(track, 300.0, 10.0, 12);
    place(track, 1, 300.0 - 4.6 * kSpacing_m, 10.0, 0);
    const std::vector<GapRequest>& requests = track.state().gap_cooperation.requests[2];
    double agreed_s = -1.0;
    double confirmed_s = -1.0;
    double ended_s = -1.0;
    for (int k = 0; k < 100; ++k) {
        track.run(0.1);
        const bool agreed = !requests.empty() && requests[0].agreed();
        if (agreed_s < 0.0 && agreed) agreed_s = track.time_s();
        if (confirmed_s < 0.0 && agreed && requests[0].is_confirmed) confirmed_s = track.time_s();
        if (agreed_s >= 0.0 && ended_s < 0.0 && !agreed) ended_s = track.time_s();
    }
    ASSERT_GE(agreed_s, 0.0) << "no agreement";
    // The requester hears of the agreement with the opener's next message.
    EXPECT_GT(confirmed_s, agreed_s - 1e-9);
    EXPECT_LE(confirmed_s, agreed_s + 0.2);
    // The last message is sent between 2.9 and 3.0 s. It stays valid for 1 s. The lanes are inspected every 0.1 s.
    EXPECT_GE(ended_s, 2.9 + 1.0);
    EXPECT_LE(ended_s, 3.0 + 1.0 + 0.1 + 0.1 + 1e-9);
    const GapCounts& counts = track.state().records.gap_counts;
    EXPECT_EQ(counts.agreed, 1);
    EXPECT_EQ(counts.of(GapEnding::lost), 1);
}

// A vehicle beyond the range does not hear the request.
TEST_P(GapCooperationTest, RequestsReachOnlyVehiclesWithinTheRange) {
    for (const bool in_range : {true, false}) {
        const std::string range = in_range ? "30 m" : "1 m";
        Track track(two_lanes(GetParam(), "cooperative", 0.0,
                              {"driver.v2v={channel: bernoulli, loss: 0 %, range: " + range + "}"}, 10.0));
        place_platoon(track, 300.0, 10.0, 12);
        place(track, 1, 300.0 - 4.6 * kSpacing_m, 10.0, 0);
        track.run(2.5);
        EXPECT_EQ(track.state().records.gap_counts.requested, 1);
        EXPECT_EQ(track.state().records.gap_counts.agreed, in_range ? 1 : 0);
    }
}

// A requester beside a platoon changes lanes to the gap that one vehicle opens.
TEST_P(GapCooperationTest, RequesterTakesTheGap) {
    Track track(two_lanes(GetParam(), "cooperative", 0.0, {}, 10.0));
    place_platoon(track, 300.0, 10.0, 12);
    const int requester = place(track, 1, 300.0 - 4.6 * kSpacing_m, 10.0, 0);
    for (double t = 0.1; t < 15.0 && !is_on(track.state(), 0, requester); t += 0.1) track.run(0.1);
    track.run(0.1);
    EXPECT_TRUE(is_on(track.state(), 0, requester));
    EXPECT_EQ(track.state().records.gap_counts.requested, 1);
    EXPECT_EQ(track.state().records.gap_counts.of(GapEnding::used), 1);
}

// Two lanes before a light that turns green after 5 s. The requester stands beside a queue without gaps. The opener
// starts later, and the requester changes lanes. Without gap opening, it changes only behind the last vehicle.
TEST_P(GapCooperationTest, StartingQueueLetsARequesterIn) {
    for (const std::string gap_opening : {"cooperative", "off"}) {
        Track track(two_lanes(GetParam(), gap_opening, 5.0));
        for (int k = 0; k < 16; ++k) place(track, 0, 998.0 - k * kSpacing_m, 0.0, 0);
        for (int k = 0; k < 8; ++k) place(track, 1, 996.0 - k * kSpacing_m, 0.0, 1);
        const int requester = place(track, 1, 996.0 - 8 * kSpacing_m, 0.0, 0);
        double changed_s = -1.0;
        for (double t = 0.1; t < 40.0; t += 0.1) {
            track.run(0.1);
            if (changed_s < 0.0 && is_on(track.state(), 0, requester)) changed_s = t;
        }
        EXPECT_TRUE(track.state().records.violations.none());
        if (gap_opening == "cooperative") {
            EXPECT_EQ(track.state().records.gap_counts.of(GapEnding::used), 1);
            EXPECT_LT(changed_s, 15.0);
        } else {
            EXPECT_EQ(track.state().records.gap_counts.requested, 0);
            EXPECT_GT(changed_s, 15.0);
        }
    }
}

// With 20 % loss most agreements still lead to a lane change.
TEST_P(GapCooperationTest, RequesterTakesTheGapDespiteLosses) {
    int used = 0;
    constexpr int kRuns = 10;
    for (int seed = 1; seed <= kRuns; ++seed) {
        Track track(two_lanes(GetParam(), "cooperative", 0.0,
                              {"driver.v2v={channel: bernoulli, loss: 20 %}", "seed=" + std::to_string(seed)}, 10.0));
        place_platoon(track, 300.0, 10.0, 12);
        const int requester = place(track, 1, 300.0 - 4.6 * kSpacing_m, 10.0, 0);
        for (double t = 0.1; t < 15.0 && !is_on(track.state(), 0, requester); t += 0.1) track.run(0.1);
        track.run(0.1);
        EXPECT_TRUE(track.state().records.violations.none());
        used += static_cast<int>(track.state().records.gap_counts.of(GapEnding::used));
    }
    EXPECT_GE(used, kRuns / 2);
}

// All vehicles of the right lane ask at the same time. Of four consecutive vehicles, at most one opens a gap.
TEST_P(GapCooperationTest, OneInFourOpensAGap) {
    Track track(two_lanes(GetParam(), "cooperative"));
    place_platoon(track, 300.0, 10.0, 20);
    for (int k = 2; k < 16; ++k) place(track, 1, 299.0 - k * kSpacing_m, 10.0, 0);
    int most = 0;
    for (double t = 0.1; t < 4.0; t += 0.1) {
        track.run(0.1);
        const State& state = track.state();
        std::vector<int> places;
        for (const GapRequest& r : state.gap_cooperation.requests[2]) {
            for (int slot = state.blocks[0].first; slot < state.blocks[0].past_last(); ++slot) {
                if (r.opener >= 0 && state.vehicles.id[at(slot)] == r.opener) places.push_back(slot);
            }
        }
        std::sort(places.begin(), places.end());
        most = std::max(most, static_cast<int>(places.size()));
        if (!state.records.lane_changes.empty())
            break;  // later, vehicles that have changed lanes would shift the slots
        for (std::size_t k = 1; k < places.size(); ++k) EXPECT_GE(places[k] - places[k - 1], 4);
    }
    EXPECT_GE(most, 3);
}

TEST_P(GapCooperationTest, ThreadsDoNotChangeTheResult) {
    const Scenario scenario =
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/berlin.yaml",
                      {"populations=[CDG]", "measure.baseline=CDG", "driver.lane_change.gap_opening=cooperative",
                       std::string("fidelity=") + GetParam()});
    const Model model = build_model(scenario, 0);
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 4}) {
        Simulation simulation(model, threads);
        simulation.run_until(300.0);
        hashes.push_back(simulation.state_hash());
        EXPECT_GT(simulation.state().records.gap_counts.of(GapEnding::used), 0);
        EXPECT_TRUE(simulation.state().records.violations.none());
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

}  // namespace
}  // namespace stopline

// Checks every result of a short intersection run against an independent count from the vehicle positions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "runs/intersection/intersection_run.h"
#include "runs/intersection/intersection_watch.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

using namespace testing_support;

constexpr std::size_t kPopulation = 4;  // P50

bool is_measured(double time_s) { return time_s >= kFrom_s && time_s < kTo_s; }

class IntersectionRun : public testing::Test {
protected:
    static void SetUpTestSuite() {
        const Scenario scenario =
            load_scenario(STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml",
                          {"demand.left=20 %", "demand.right=5 %", "step=20 ms", "measure.cycles=2"});
        result_ = std::make_unique<IntersectionResult>(run_intersection(scenario, kPopulation));
        model_ = std::make_unique<Model>(build_model(scenario, kPopulation));
        watch_ = std::make_unique<IntersectionWatch>(*model_);
        Simulation simulation(*model_);
        watch_->observe(simulation.state());
        while (simulation.time_s() < kTo_s - 1e-9) {
            simulation.step();
            watch_->observe(simulation.state());
        }
        ASSERT_EQ(simulation.state_hash(), result_->state_hash) << "the runs differ";
    }
    static void TearDownTestSuite() {
        watch_.reset();
        model_.reset();
        result_.reset();
    }

    static inline std::unique_ptr<IntersectionResult> result_;
    static inline std::unique_ptr<Model> model_;
    static inline std::unique_ptr<IntersectionWatch> watch_;
};

TEST_F(IntersectionRun, ThroughputAndTurnSharesCountExitedVehicles) {
    std::map<int, int> turned;  // [quarter turns counter-clockwise]
    int exited = 0;
    for (const auto& [id, trip] : watch_->trips) {
        if (!is_measured(trip.exit_s)) continue;
        ++exited;
        // Both strings list the legs counter-clockwise. Each leg in "enws" is opposite to the leg at the same place in
        // "wsen", so 0 means straight on.
        ++turned[static_cast<int>(std::string("enws").find(trip.to) - std::string("wsen").find(trip.from) + 4) % 4];
    }
    ASSERT_GT(turned[1], turned[3]) << "left and right can be told apart";
    EXPECT_DOUBLE_EQ(result_->throughput_veh_h, exited * 3600.0 / (kTo_s - kFrom_s));
    EXPECT_DOUBLE_EQ(result_->straight_share, 1.0 * turned[0] / exited);
    EXPECT_DOUBLE_EQ(result_->left_share, 1.0 * turned[1] / exited);
    EXPECT_DOUBLE_EQ(result_->right_share, 1.0 * turned[3] / exited);
}

TEST_F(IntersectionRun, ZonesAverageTravelTimesAndDensities) {
    ASSERT_EQ(result_->zones.size(), 2u);
    for (std::size_t zone = 0; zone < 2; ++zone) {
        double travel_s = 0.0;
        int exited = 0;
        for (const auto& [id, trip] : watch_->trips) {
            if (!is_measured(trip.zone_out_s[zone])) continue;
            travel_s += trip.zone_out_s[zone] - trip.zone_in_s[zone];
            ++exited;
        }
        const double mean_s = travel_s / exited;
        const double vehicles = watch_->zone_sum[zone] / watch_->steps;
        const double occupied = vehicles * watch_->length_m / (8.0 * 2.0 * kZones_m[zone]);
        EXPECT_EQ(result_->zones[zone].exited, exited);
        EXPECT_NEAR(result_->zones[zone].travel_time_s, mean_s, 0.01);
        EXPECT_NEAR(result_->delay_s[zone], mean_s - 2.0 * kZones_m[zone] / kLimit_mps, 0.01);
        EXPECT_NEAR(result_->zones[zone].vehicles, vehicles, 0.002 * vehicles);
        EXPECT_NEAR(result_->zones[zone].occupied, occupied, 0.002 * occupied);
    }
}

TEST_F(IntersectionRun, DensityCoversTheWholeNetwork) {
    const double present = watch_->present_sum / watch_->steps;
    EXPECT_NEAR(result_->vehicles_present, present, 0.005 * present);  // the run samples once a second
    const double occupied = present * watch_->length_m / kRoad_m;
    EXPECT_NEAR(result_->occupied, occupied, 0.005 * occupied);
    EXPECT_EQ(result_->entered, static_cast<std::int64_t>(watch_->trips.size()));
    EXPECT_EQ(result_->entered - result_->exited, watch_->present);
}

TEST_F(IntersectionRun, QueuesAreThoseAtTheStartOfGreen) {
    ASSERT_EQ(watch_->queues, 8 * kCycles);
    EXPECT_DOUBLE_EQ(result_->queue_veh, 1.0 * watch_->queued / watch_->queues);
    EXPECT_NEAR(result_->longest_queue_m, watch_->longest_m, 1e-4);
}

// The passage of a stop line. The time counts from the start of green.
struct LinePassage {
    double time_s;
    bool queued;
    bool operator<(const LinePassage& other) const { return time_s < other.time_s; }
};

// Returns the number of vehicles before the first one that has not queued.
std::size_t queue_end(const std::vector<LinePassage>& passages) {
    const auto first = std::find_if(passages.begin(), passages.end(), [](const LinePassage& p) { return !p.queued; });
    return static_cast<std::size_t>(first - passages.begin());
}

TEST_F(IntersectionRun, DischargeComesFromStopLinePassages) {
    std::map<std::pair<int, int>, std::vector<LinePassage>> passages_s;  // [lane, cycle]
    double passed = 0.0;
    for (const auto& [id, trip] : watch_->trips) {
        if (!is_measured(trip.line_s)) continue;
        ++passed;
        const double green_s = trip.line_s - kFrom_s - (trip.from == 's' || trip.from == 'n' ? kStage_s : 0.0);
        const double cycle = std::floor(green_s / (2.0 * kStage_s));
        if (cycle >= 0.0)
            passages_s[{trip.entry, static_cast<int>(cycle)}].push_back(
                {green_s - 2.0 * kStage_s * cycle, trip.queued});
    }
    const Discharge& d = result_->discharge;
    ASSERT_EQ(d.lanes.size(), 8U);
    double saturated_s = 0.0;
    int saturated = 0;
    int samples = 0;
    for (auto& [green, passages] : passages_s) {
        std::sort(passages.begin(), passages.end());
        const std::size_t end = queue_end(passages);
        for (std::size_t k = 4; k < end; ++k) saturated_s += passages[k].time_s - passages[k - 1].time_s;
        saturated += static_cast<int>(std::max<std::size_t>(end, 4) - 4);
        samples += static_cast<int>(end);
    }
    int counted = 0;
    for (const LaneDischarge& lane : d.lanes)
        counted = std::accumulate(lane.samples.begin(), lane.samples.end(), counted);
    EXPECT_EQ(counted, samples);
    ASSERT_GT(saturated, 50);
    EXPECT_NEAR(d.saturation_headway_s, saturated_s / saturated, 1e-3);
    EXPECT_NEAR(d.saturation_flow_veh_h, 3600.0 * saturated / saturated_s, 2.0);
    EXPECT_DOUBLE_EQ(d.vehicles_per_green, passed / 8.0 / kCycles);
}

TEST_F(IntersectionRun, LongestTimeInJunctionRunsFromStopLineToRearOut) {
    double longest_s = 0.0;
    for (const auto& [id, trip] : watch_->trips) longest_s = std::max(longest_s, trip.inside_s);
    EXPECT_GT(longest_s, 5.0);
    EXPECT_NEAR(result_->longest_in_junction_s, longest_s, 2.0 * kStep_s);
}

}  // namespace
}  // namespace stopline

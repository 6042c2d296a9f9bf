// No two vehicles of a platoon touch, whatever the radio does: random starts and full brakings with losses in bursts,
// blackouts of the whole radio, mixed vehicles and speeds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "base/random.h"
#include "support/track.h"
#include "v2v/channel.h"
#include "vehicle/powertrain_step.h"

namespace stopline {
namespace {

using namespace testing_support;

// A channel like gilbert, but without any delivery in a period.
struct Blackout {
    std::int64_t first = -1;  // number of the first lost message
    std::int64_t end = -1;
};
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): a channel is a function without a state
Blackout blackout;

bool delivers_outside_blackout(const V2vSettings& settings, const V2vMessage& message) {
    if (message.number >= blackout.first && message.number < blackout.end) return false;
    return find_v2v_channel("gilbert").is_delivered(settings, message);
}

const V2vChannel kBlackoutChannel{"blackout", "for tests", {}, false, delivers_outside_blackout, nullptr};

constexpr int kCar = 0;
constexpr int kElectric = 1;
constexpr int kLorry = 2;
constexpr double kFull_mps2 = 7.0;
constexpr double kFall_mps3 = 25.0;  // cacc.jerk_down

Model mixed_model(const std::string& v2v, double limit_kmh) {
    TrackPlan plan;
    plan.policy = "P";
    plan.limit_mps = limit_kmh / 3.6;
    plan.length_m = 3000.0;
    plan.overrides = {"driver.v2v=" + v2v, "measure.baseline=P", "demand.vehicles=1",
                      "populations=[{name: P, components: [{policy: CDG, share: 50 %}, {policy: CDG, share: 20 %, "
                      "vehicle: electric_100kw}, {policy: CDG-6m, share: 30 %, vehicle: articulated_lorry_35t, driver: "
                      "lorry}]}]"};
    return build_model(scenario_of(plan), 0);
}

struct Outcome {
    double smallest_gap_m = 1e9;
    bool starts = false;  // the platoon starts from rest
    bool blackout_at_braking = false;
    int old_messages = 0;  // followers with a message older than 0.3 s when the leader begins to brake
    std::string report;    // the pair with the smallest gap at that time
};

class Trial {
public:
    Trial(const Model& model, std::uint64_t number)
        : number_(number), track_(model), limit_mps_(track_.model().graph.lanes[0].limit_mps) {
        const bool from_rest = draw(0) < 0.5;
        speed_mps_ = from_rest ? 0.0 : limit_mps_ * (0.6 + 0.4 * draw(1));
        brake_s_ = from_rest ? 3.0 + 15.0 * draw(2) : 1.0 + 8.0 * draw(2);
        outcome_.starts = from_rest;
        blackout = {};
        if (draw(3) < 0.5) {  // 10 s that begin at most 9 s before the braking, or up to 1 s after it
            const double from_s = std::max(brake_s_ - 9.0 + 10.0 * draw(4), 0.0);
            blackout = {std::llround(10.0 * from_s), std::llround(10.0 * (from_s + 10.0))};
            outcome_.blackout_at_braking = from_s < brake_s_;
        }
        const int vehicles = 4 + static_cast<int>(8.0 * draw(5));
        double rear_m = 400.0;
        for (int k = 0; k < vehicles; ++k) {
            const double type_draw = draw(10 + static_cast<std::uint64_t>(k));
            const int type = type_draw < 0.5 ? kCar : type_draw < 0.7 ? kElectric : kLorry;
            const double standstill_m = track_.model().policies[at(type)].settings.standstill_gap_m;
            const double gap_m = std::max(standstill_m, 0.5 + (type == kLorry ? 0.5 : 0.4) * speed_mps_);
            const double front_m = k == 0 ? rear_m : rear_m - gap_m;
            track_.place(0, front_m, speed_mps_, type, track_.model().classes[at(type)].vehicle);
            if (k > 0) track_.make_follower(0, k);
            rear_m = front_m - track_.model().vehicles[at(track_.model().classes[at(type)].vehicle)].length_m;
        }
    }

    Outcome run() {
        double position_m = track_.vehicle(0, 0).position_m;
        // The first vehicle has the powertrain of its type, so it brakes as hard as a vehicle can.
        const PowertrainTables& tables =
            track_.model().vehicles[at(track_.state().vehicles.type_of(track_.slot(0, 0)))];
        PowertrainState<double> head{};
        head.speed_mps = speed_mps_;
        head.gear = cruising_gear(tables, speed_mps_);
        head.gear_time_s = 100.0;
        head.lag_s = 0.2;
        double request = 0.0;
        double rest_s = 0.0;
        bool has_braked = false;
        while (rest_s < 8.0) {
            const bool brakes = track_.time_s() >= brake_s_;
            if (brakes && !has_braked) note_messages();
            has_braked = brakes;
            // The request falls as fast as that of any driver may fall.
            const double wanted = brakes ? -kFull_mps2 : std::clamp(0.35 * (limit_mps_ - speed_mps_), 0.0, 2.2);
            request = std::clamp(wanted, request - kFall_mps3 * 0.01, request + 0.06);
            track_.drive(0, 0, position_m, speed_mps_, head.acceleration_mps2, request, head.lag_s);
            head = powertrain_step<double>(tables, head, request, 0.0, 0.01);
            const double before_mps = speed_mps_;
            speed_mps_ = std::max(speed_mps_ + 0.01 * head.acceleration_mps2, 0.0);
            if (speed_mps_ == 0.0 && brakes) head.acceleration_mps2 = 0.0, rest_s += 0.01;
            head.speed_mps = speed_mps_;
            position_m += 0.005 * (before_mps + speed_mps_);
            track_.step();
            if (testing::Test::HasFatalFailure()) {
                outcome_.smallest_gap_m = -1.0;
                return outcome_;
            }
            watch_gaps();
        }
        return outcome_;
    }

private:
    double draw(std::uint64_t index) const { return random_uniform(2024, number_, index, Purpose::insertion); }

    void note_messages() {
        for (int k = 1; k < track_.count(0); ++k) {
            const int sent_tick = track_.state().vehicles.v2v.sent_tick[track_.slot(0, k)];
            outcome_.old_messages += track_.state().tick - sent_tick > 30 ? 1 : 0;
        }
    }

    void watch_gaps() {
        for (int k = 1; k < track_.count(0); ++k) {
            const VehicleView follower = track_.vehicle(0, k);
            if (follower.gap_m >= outcome_.smallest_gap_m) continue;
            outcome_.smallest_gap_m = follower.gap_m;
            const VehicleView leader = track_.vehicle(0, k - 1);
            const V2vReceivers& received = track_.state().vehicles.v2v;
            const std::size_t slot = track_.slot(0, k);
            outcome_.report = "trial " + std::to_string(number_) + " vehicle " + std::to_string(k) + " policy " +
                              std::to_string(track_.state().vehicles.policy[track_.slot(0, k)]) + ": " +
                              std::to_string(track_.time_s() - brake_s_) + " s after the braking, gap " +
                              std::to_string(follower.gap_m) + " m, speeds " + std::to_string(leader.speed_mps) + " " +
                              std::to_string(follower.speed_mps) + ", requests " + std::to_string(leader.request_mps2) +
                              " " + std::to_string(follower.request_mps2) + ", mode " +
                              kV2vModeNames[static_cast<std::size_t>(received.mode[slot])] + ", age " +
                              std::to_string(track_.state().tick - received.sent_tick[slot]);
        }
    }

    std::uint64_t number_;
    Track track_;
    double limit_mps_;
    double speed_mps_ = 0.0;
    double brake_s_ = 0.0;
    Outcome outcome_;
};

// The variable STOPLINE_V2V_TRIALS sets the number of trials of each test.
std::uint64_t trials() {
    const char* const text = std::getenv("STOPLINE_V2V_TRIALS");
    return text == nullptr ? 100 : std::strtoull(text, nullptr, 10);
}

class RadioSafety : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Limits, RadioSafety, testing::Values(30.0, 50.0, 70.0),
                         [](const auto& limit) { return std::to_string(static_cast<int>(limit.param)) + "kmh"; });

TEST_P(RadioSafety, NoVehiclesTouchWithBurstsAndBlackouts) {
    Model model = mixed_model("{channel: gilbert, loss: 20 %, burst: 20}", GetParam());
    model.v2v_plan.channel = &kBlackoutChannel;
    int blackouts = 0;
    int starts = 0;
    int old_messages = 0;
    Outcome worst;
    for (std::uint64_t number = 0; number < trials(); ++number) {
        const Outcome outcome = Trial(model, number).run();
        ASSERT_FALSE(HasFatalFailure()) << "trial " << number << ", " << outcome.report;
        blackouts += outcome.blackout_at_braking ? 1 : 0;
        starts += outcome.starts ? 1 : 0;
        old_messages += outcome.old_messages;
        if (outcome.smallest_gap_m < worst.smallest_gap_m) worst = outcome;
    }
    EXPECT_GT(worst.smallest_gap_m, 0.0) << worst.report;
    // The situations came up.
    EXPECT_GT(blackouts, static_cast<int>(trials() / 4));
    EXPECT_GT(starts, static_cast<int>(trials() / 4));
    EXPECT_GT(old_messages, static_cast<int>(trials()));
    RecordProperty("worst", worst.report);
    if (std::getenv("STOPLINE_V2V_TRIALS") != nullptr) std::puts(worst.report.c_str());
}

TEST_P(RadioSafety, NoVehiclesTouchWithTenMessagesASecond) {
    const Model model = mixed_model("{channel: ideal, interval: 100 ms}", GetParam());
    Outcome worst;
    for (std::uint64_t number = 0; number < trials(); ++number) {
        const Outcome outcome = Trial(model, number).run();
        ASSERT_FALSE(HasFatalFailure()) << "trial " << number << ", " << outcome.report;
        if (outcome.smallest_gap_m < worst.smallest_gap_m) worst = outcome;
    }
    EXPECT_GT(worst.smallest_gap_m, 0.0) << worst.report;
    if (std::getenv("STOPLINE_V2V_TRIALS") != nullptr) std::puts(worst.report.c_str());
}

}  // namespace
}  // namespace stopline

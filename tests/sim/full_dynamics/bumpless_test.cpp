// The acceleration request changes no faster than its jerk limits when a vehicle switches between free driving,
// following, stopping and the regimes of its policy. The request of a stopped vehicle starts from zero.
#include <gtest/gtest.h>

#include <map>

#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

class Bumpless : public testing::TestWithParam<Pairing> {};
INSTANTIATE_TEST_SUITE_P(SlowEveryPairing, Bumpless, testing::ValuesIn(every_pairing()), as_pairing_name);
INSTANTIATE_TEST_SUITE_P(TwoPairings, Bumpless,
                         testing::Values(Pairing{"SWITCH-1", "petrol_eu4_72kw"}, Pairing{"MIX", "electric_100kw"}),
                         as_pairing_name);

constexpr double kSinglePrecision_mps2 = 1e-6;

struct Request {
    double value_mps2;
    double speed_mps;
};

std::map<int, Request> requests(const Track& track) {
    std::map<int, Request> by_id;
    for (int lane = 0; lane < 2; ++lane) {
        for (int k = 0; k < track.count(lane); ++k) {
            const VehicleView car = track.vehicle(lane, k);
            by_id[car.id] = {car.request_mps2, car.speed_mps};
        }
    }
    return by_id;
}

// A queue starts and accelerates beyond the switching speeds. The signal splits it, and the rear part stops again.
TEST_P(Bumpless, RequestsStayWithinTheJerkLimits) {
    TrackPlan plan;
    plan.policy = GetParam().policy;
    plan.vehicle = GetParam().vehicle;
    plan.length_m = 600.0;
    plan.exit_m = 400.0;
    plan.green_from_s = 2.0;
    plan.green_s = 18.0;
    Track track(plan);
    track.place_platoon(0, 599.0, 0.0, 40);
    const CaccSettings& cacc = track.model().common_driver().cacc;
    const double up = cacc.jerk_up_mps3 * track.step_s() + kSinglePrecision_mps2;
    const double down = cacc.jerk_down_mps3 * track.step_s() + kSinglePrecision_mps2;
    double fastest = 0.0;
    std::map<int, Request> before = requests(track);
    while (track.time_s() < 50.0) {
        track.step();
        if (HasFatalFailure()) return;
        std::map<int, Request> now = requests(track);
        for (const auto& [id, request] : now) {
            fastest = std::max(fastest, request.speed_mps);
            const Request& previous = before.at(id);
            const double change = request.value_mps2 - previous.value_mps2;
            ASSERT_GE(change, -down) << "vehicle " << id << " at " << track.time_s() << " s";
            const bool from_rest = previous.speed_mps <= 1e-3 && previous.value_mps2 < 0.0;
            ASSERT_LE(from_rest ? request.value_mps2 : change, up) << "vehicle " << id << " at " << track.time_s();
        }
        before = std::move(now);
    }
    EXPECT_GT(fastest, 12.0);
    EXPECT_GT(track.state().records.passages.size(), 3u);
    EXPECT_GT(track.count(0), 10) << "vehicles that the signal holds back";
}

}  // namespace
}  // namespace stopline

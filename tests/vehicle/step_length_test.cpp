// Tests that the powertrain's behaviour does not depend on the step length.
#include <gtest/gtest.h>

#include <vector>

#include "support/cars.h"

namespace stopline {
namespace {

using namespace testing_support;

class StepLength : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(EveryVehicle, StepLength, testing::ValuesIn(car_names()), as_test_name);

// Returns a requested acceleration. It leads to a start, gear changes, changes between drive and brake, and a stop.
double request_at(double t) {
    if (t < 2.0) return 0.0;
    if (t < 12.0) return 1.8;
    if (t < 20.0) return 0.8 * std::sin(t - 12.0);
    if (t < 26.0) return -1.5;
    if (t < 36.0) return 1.2;
    return -3.0;
}

struct Journey {
    std::vector<double> speed_mps;  // one value every 0.1 s
    double distance_m = 0.0;
};

Journey journey(const Car& car, double dt) {
    Journey result;
    CarState s = cruising(car, 0.0);
    const int per_sample = static_cast<int>(std::lround(0.1 / dt));
    for (int k = 0; k < 500 * per_sample; ++k) {
        const CarState next = advance(car, s, request_at((k + 0.5) * dt), car.grade_N(0.01), dt);
        result.distance_m += 0.5 * (s.speed_mps + next.speed_mps) * dt;
        s = next;
        if (k % per_sample == per_sample - 1) result.speed_mps.push_back(s.speed_mps);
    }
    return result;
}

TEST_P(StepLength, DoesNotChangeAJourney) {
    const Car car(GetParam());
    const Journey fine = journey(car, 0.0025);
    for (const double dt : {0.005, 0.01, 0.02}) {
        const Journey coarse = journey(car, dt);
        // A gear change begins and ends at a step, so the vehicle may lack torque for up to one step longer.
        EXPECT_NEAR(coarse.distance_m, fine.distance_m, (car.electric() ? 0.1 : 1.5) * dt / 0.01) << dt;
        for (std::size_t k = 0; k < fine.speed_mps.size(); ++k) {
            ASSERT_NEAR(coarse.speed_mps[k], fine.speed_mps[k], 0.05 * dt / 0.01)
                << "step " << dt << ", at " << 0.1 * static_cast<double>(k) << " s";
        }
    }
}

}  // namespace
}  // namespace stopline

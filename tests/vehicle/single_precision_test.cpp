// Compares the kernels' powertrain in single precision with the same equations in double precision.
#include "base/simd/narrowed.h"
#include "support/cars.h"

namespace stopline {
namespace {

using testing_support::Car;
using testing_support::CarState;

// Returns a requested acceleration: a start, cruising, gentle and hard braking and another start within 60 s.
double request_at(double time_s) {
    if (time_s < 15.0) return 1.8;
    if (time_s < 25.0) return 0.0;
    if (time_s < 31.0) return -1.2;
    if (time_s < 40.0) return 0.8;
    return time_s < 50.0 ? -3.0 : 1.0;
}

class SinglePrecision : public testing::TestWithParam<std::string> {};

TEST_P(SinglePrecision, StaysWithinMillimetresPerSecondOfDouble) {
    const Car car(GetParam());
    const PowertrainTablesOf<float> narrow = narrowed(car.tables);
    CarState wide = testing_support::cruising(car, 0.0);
    double speed_mps = 0.0;
    PowertrainState<Single> s{0.0, 0.0, 0.0, 0.0, wide.gear_time_s, wide.lag_s, wide.gear};
    double largest_mps = 0.0;
    for (int tick = 0; tick < 6000; ++tick) {
        const double request = request_at(0.01 * tick);
        wide = testing_support::advance(car, wide, request, 0.0, 0.01);
        s = powertrain_step<Single>(narrow, s, Single(request), 0.0, 0.01);
        // Like this test, the simulation adds the small increments in double precision.
        const double next_mps = speed_mps + static_cast<double>(s.acceleration_mps2.v) * 0.01;
        speed_mps = next_mps > 1e-6 ? next_mps : 0.0;
        s.speed_mps = Single(speed_mps);
        largest_mps = std::max(largest_mps, std::abs(speed_mps - wide.speed_mps));
    }
    EXPECT_LT(largest_mps, 2e-3);
    EXPECT_GT(largest_mps, 0.0) << "both results are in double precision";
}

INSTANTIATE_TEST_SUITE_P(EveryVehicle, SinglePrecision, testing::ValuesIn(testing_support::car_names()),
                         testing_support::as_test_name);

}  // namespace
}  // namespace stopline

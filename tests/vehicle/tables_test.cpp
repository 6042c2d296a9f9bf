// Tests of compile_powertrain(): curves keep their shape on the grid of the tables, and inconsistent settings are
// refused with a message that names the setting.
#include <gtest/gtest.h>

#include <functional>

#include "base/input_error.h"
#include "support/cars.h"

namespace stopline {
namespace {

using namespace testing_support;

class Tables : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(EveryVehicle, Tables, testing::ValuesIn(car_names()), as_test_name);

TEST_P(Tables, KeepTheShapeOfTheTorqueCurves) {
    const Car car(GetParam());
    for (double rpm = 0.0; rpm <= car.settings.limiter_rpm; rpm += 10.0) {
        const double cell = rpm * car.tables.torque_nodes_per_rpm;
        const double full = interpolate_on_grid(car.tables.full_load_Nm, cell);
        const double drag = interpolate_on_grid(car.tables.drag_Nm, cell);
        EXPECT_NEAR(full, interpolate(car.settings.full_load, rpm), 0.03 * full) << rpm;
        // The tolerance covers corners of the curve that lie between grid nodes.
        EXPECT_NEAR(drag, interpolate(car.settings.drag_torque, rpm), 5.0) << rpm;
        EXPECT_LE(drag, 0.0);
    }
}

TEST_P(Tables, CruiseInTheHighestPossibleGear) {
    const Car car(GetParam());
    for (double v = 0.0; v < 50.0; v += 0.5) {
        const int gear = cruising_gear(car.tables, v);
        if (gear > 0) {
            EXPECT_GE(car.rpm(v, gear), car.settings.shift_down_rpm);
        }
        if (gear + 1 < car.tables.gears) {
            EXPECT_LT(car.rpm(v, gear + 1), 1.1 * car.settings.shift_down_rpm);
        }
    }
}

TEST(Interpolate, IsLinearBetweenAndConstantBeyond) {
    const SampledCurve curve{{1.0, 2.0, 4.0}, {10.0, 20.0, 0.0}};
    EXPECT_EQ(interpolate(curve, -5.0), 10.0);
    EXPECT_EQ(interpolate(curve, 1.0), 10.0);
    EXPECT_EQ(interpolate(curve, 1.5), 15.0);
    EXPECT_EQ(interpolate(curve, 2.0), 20.0);
    EXPECT_EQ(interpolate(curve, 3.0), 10.0);
    EXPECT_EQ(interpolate(curve, 9.0), 0.0);
}

struct Damage {
    const char* name;
    std::function<void(PowertrainSettings&)> apply;
};

const Damage kDamages[] = {
    {"no gear", [](auto& s) { s.gear_ratio.clear(), s.rotating_mass_factor.clear(), s.lag_gear_factor.clear(); }},
    {"nine gears", [](auto& s) { s.gear_ratio = s.rotating_mass_factor = s.lag_gear_factor = std::vector(9, 1.0); }},
    {"a rotating mass missing", [](auto& s) { s.rotating_mass_factor.pop_back(); }},
    {"a lag factor missing", [](auto& s) { s.lag_gear_factor.pop_back(); }},
    {"no full load", [](auto& s) { s.full_load = {}; }},
    {"a torque missing", [](auto& s) { s.full_load.y.pop_back(); }},
    {"a drag torque missing", [](auto& s) { s.drag_torque.y.pop_back(); }},
    {"no lag map", [](auto& s) { s.lag_drive_s.clear(), s.lag_rpm.clear(); }},
    {"a lag missing", [](auto& s) { s.lag_drive_s.pop_back(); }},
    {"limiter below idle", [](auto& s) { s.limiter_rpm = 0.5 * s.idle_rpm; }},
};

TEST(CompilePowertrain, RefusesInconsistentSettings) {
    for (const Damage& damage : kDamages) {
        PowertrainSettings settings = load_vehicle("petrol_eu4_72kw");
        settings.name = "my car";
        damage.apply(settings);
        try {
            compile_powertrain(settings);
            ADD_FAILURE() << damage.name << " was accepted";
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("my car"), std::string::npos) << error.what();
        }
    }
}

}  // namespace
}  // namespace stopline

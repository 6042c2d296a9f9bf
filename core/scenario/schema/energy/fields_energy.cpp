// Fields of the energy use of a vehicle.
#include <string>
#include <vector>

#include "scenario/schema/field_rows.h"
#include "scenario/schema/fields.h"

namespace stopline {
namespace {

void check_energy(const EnergySettings& energy, Checker& check) {
    if (energy.source == "fuel") {
        if (energy.fuel_rate.x.front() != 0.0) {
            check.error("fuel_rate", "begins at " + short_text(energy.fuel_rate.x.front(), unit("kW")) +
                                         ", but must begin at 0 kW: below, the rate falls to 0 g/h at the drag torque");
        }
        return;
    }
    if (energy.loss_torque_Nm.front() != 0.0) {
        check.error("loss_torques", "must begin at 0 N m; the losses are the same for driving and recuperation");
    }
    const std::size_t values = energy.loss_rpm.size() * energy.loss_torque_Nm.size();
    if (energy.loss_W.size() != values) {
        check.error("losses", "has " + std::to_string(energy.loss_W.size()) + " values, but the map has " +
                                  std::to_string(energy.loss_rpm.size()) + " speeds x " +
                                  std::to_string(energy.loss_torque_Nm.size()) + " torques");
    }
}

}  // namespace

const Table& energy_table() {
    using S = EnergySettings;
    static const Table table = make_table<S>(
        "the energy use of a vehicle",
        {
            choice<&S::source>("source", {"fuel", "battery"}, "fuel: combustion engine; battery: electric motor"),
            curve<&S::fuel_rate>(
                "fuel_rate", {"kW", {0, 2000}}, {"g/h", {0, 1'000'000}}, {2, 200},
                "fuel rate by engine power, from 0 kW on; beyond the last point, it rises with the "
                "slope of the last segment; when the wheels drive the engine, the rate falls from the value at 0 kW to "
                "0 g/h at the drag torque")
                .required()
                .only_if("source", {"fuel"}),
            number<&S::idle_fuel_g_per_h>("idle_fuel", "g/h", {0, 100'000}, "fuel rate at standstill")
                .required()
                .only_if("source", {"fuel"}),
            number<&S::map_efficiency>("map_efficiency", "%", {10, 100},
                                       "driveline efficiency with which the data behind fuel_rate compute engine power "
                                       "from wheel power; 100 %: fuel_rate belongs to the power of the engine itself")
                .only_if("source", {"fuel"}),
            number<&S::fuel_density_kg_per_m3>("fuel_density", "g/l", {100, 1500}, "density of the fuel")
                .required()
                .only_if("source", {"fuel"}),
            number<&S::co2_per_fuel>("co2_per_fuel", "", {0, 10}, "mass of CO2 / mass of fuel")
                .required()
                .only_if("source", {"fuel"}),
            numbers<&S::loss_rpm>("loss_speeds", "rpm", {0, 30'000}, {1, 100}, "motor speeds of the loss map", true)
                .required()
                .only_if("source", {"battery"}),
            numbers<&S::loss_torque_Nm>("loss_torques", "N m", {0, 5000}, {1, 100},
                                        "torques of the loss map; recuperation has the losses of the same torque", true)
                .required()
                .only_if("source", {"battery"}),
            numbers<&S::loss_W>("losses", "W", {0, 1'000'000}, {1, 10'000},
                                "losses of motor and inverter: for each of loss_speeds, the values at all loss_torques")
                .required()
                .only_if("source", {"battery"}),
            number<&S::battery_V>("battery_voltage", "V", {10, 2000}, "open-circuit voltage of the battery")
                .required()
                .only_if("source", {"battery"}),
            number<&S::battery_ohm>("battery_resistance", "ohm", {0, 10}, "internal resistance of the battery")
                .required()
                .only_if("source", {"battery"}),
            number<&S::auxiliaries_W>("auxiliaries", "kW", {0, 100},
                                      "constant power of auxiliaries, from the engine or from the battery; at "
                                      "standstill, idle_fuel includes it"),
        },
        check_energy);
    return table;
}

}  // namespace stopline

// The metrics of energy. Only scenarios with `measure.energy: on` have them.
#pragma once

#include "base/units.h"
#include "runs/metrics/shared_metrics.h"

namespace stopline {

inline bool asks_for_energy(const Scenario& scenario) { return scenario.measure.energy == "on"; }

template <class Run>
MetricList<Run> fuel_metrics() {
    const auto fuel = [](const Run& run) -> const EnergySums& { return run.counts().driving.energy.totals.fuel; };
    const auto totals = [](const Run& run) -> const EnergyTotals& { return run.counts().driving.energy.totals; };
    return {
        {.column = "fuel_g_per_veh",
         .unit = "g/veh",
         .extent = "window",
         .meaning =
             "mean fuel of a vehicle with an engine, from its entry to its exit, also before the window and outside the "
             "measured area. The vehicles that leave the network in the window count; single light: all vehicles. This "
             "column and those up to `energy_residual_percent` are written only with `measure.energy: on`; the "
             "mesoscale mode estimates them",
         .value = [=](const Run& run) { return fuel(run).per_vehicle(); },
         .summary_decimals = 3,
         .console = {.heading = "fuel",
                     .decimals = 1,
                     .note = "mean fuel of a vehicle on its whole way",
                     .begins_part = true}},
        {.column = "fuel_g_per_km",
         .unit = "g/km",
         .extent = "window",
         .meaning = "fuel of these vehicles divided by their distance",
         .value = [=](const Run& run) { return fuel(run).per_km(); },
         .summary_decimals = 3,
         .figure = {.axis = "fuel", .sweep = {.change = "fuel saved against {} [%]", .better = Better::lower}}},
        {.column = "fuel_g_per_stop",
         .unit = "g/stop",
         .extent = "window",
         .meaning = "fuel of these vehicles divided by their number of stops; empty: no stops",
         .value = [=](const Run& run) { return fuel(run).per_stop(); },
         .summary_decimals = 3},
        {.column = "fuel_l_per_100km",
         .unit = "l/100 km",
         .extent = "window",
         .meaning = "fuel of these vehicles in litres, divided by their distance",
         .value =
             [=](const Run& run) {
                 const double km = fuel(run).distance_km;
                 return km > 0.0 ? 100.0 * totals(run).fuel_l / km : kNan;
             },
         .summary_decimals = 3},
        {.column = "co2_g_per_veh",
         .unit = "g/veh",
         .extent = "window",
         .meaning = "mean CO2 of these vehicles from burning their fuel",
         .value =
             [=](const Run& run) { return fuel(run).vehicles > 0 ? totals(run).co2_g / fuel(run).vehicles : kNan; },
         .summary_decimals = 2},
        {.column = "co2_g_per_km",
         .unit = "g/km",
         .extent = "window",
         .meaning = "CO2 of these vehicles divided by their distance",
         .value =
             [=](const Run& run) {
                 return fuel(run).distance_km > 0.0 ? totals(run).co2_g / fuel(run).distance_km : kNan;
             },
         .summary_decimals = 2,
         .console = {.heading = "CO2", .decimals = 1, .note = "for each kilometre"}}};
}

template <class Run>
MetricList<Run> battery_metrics() {
    const auto battery = [](const Run& run) -> const EnergySums& { return run.counts().driving.energy.totals.battery; };
    return {{.column = "energy_Wh_per_veh",
             .unit = "Wh/veh",
             .extent = "window",
             .meaning =
                 "mean energy from the battery of an electric vehicle on its whole way, less recuperation; empty: no "
                 "electric vehicles",
             .value = [=](const Run& run) { return battery(run).per_vehicle(); },
             .summary_decimals = 3},
            {.column = "energy_Wh_per_km",
             .unit = "Wh/km",
             .extent = "window",
             .meaning = "energy of these vehicles divided by their distance",
             .value = [=](const Run& run) { return battery(run).per_km(); },
             .summary_decimals = 3,
             .console = {.heading = "electric\nenergy", .decimals = 1, .note = "from the battery, less recuperation"}},
            {.column = "energy_Wh_per_stop",
             .unit = "Wh/stop",
             .extent = "window",
             .meaning = "energy of these vehicles divided by their number of stops; empty: no stops",
             .value = [=](const Run& run) { return battery(run).per_stop(); },
             .summary_decimals = 3}};
}

// Returns all metrics of energy.
template <class Run>
MetricList<Run> energy_metrics() {
    const auto energy = [](const Run& run) -> const EnergyResult& { return run.counts().driving.energy; };
    const auto per_vehicle = [=](const Run& run, double sum) {
        const int vehicles = energy(run).totals.vehicles;
        return vehicles > 0 ? sum / vehicles : kNan;
    };
    MetricList<Run> metrics = joined_lists<Run>(
        {fuel_metrics<Run>(),
         battery_metrics<Run>(),
         {{.column = "energy_vehicles",
           .unit = "veh",
           .extent = "window",
           .meaning = "vehicles in these means",
           .value = [=](const Run& run) { return energy(run).totals.vehicles; }},
          {.column = "stops_per_veh",
           .extent = "window",
           .meaning = "mean number of stops of these vehicles, including a standstill at entry; the next stop counts "
                      "only after a speed above 5 km/h",
           .value = [=](const Run& run) { return per_vehicle(run, energy(run).totals.stops); },
           .summary_decimals = 3},
          {.column = "idle_s_per_veh",
           .unit = "s/veh",
           .extent = "window",
           .meaning = "mean time for which these vehicles are stopped",
           .value = [=](const Run& run) { return per_vehicle(run, energy(run).totals.idle_s); },
           .summary_decimals = 2},
          {.column = "energy_residual_percent",
           .unit = "%",
           .extent = "run",
           .meaning =
               "error of the energy balance: work of engines and motors minus braking, resistances, slope and changes of "
               "kinetic energy, in percent of the positive work; 0: the balance closes; empty: mesoscale mode",
           .value = [=](const Run& run) { return energy(run).residual_percent(); },
           .summary_decimals = 5}}});
    for (Metric<Run>& metric : metrics) metric.asked_for = asks_for_energy;
    return metrics;
}

}  // namespace stopline

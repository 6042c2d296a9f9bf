// A scenario as loaded from YAML: everything an experiment needs, in SI units, checked and complete. Plain data.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "demand/demand_settings.h"
#include "driver/driver_settings.h"
#include "driver/hindrance_rules.h"
#include "network/network_settings.h"
#include "signals/signal_settings.h"
#include "vehicle/powertrain_settings.h"

namespace stopline {

struct MeasureSettings {
    std::vector<double> green_s;  // green times at which the passed vehicles are reported
    std::string baseline;         // population that improvements refer to
    // Intersections: cycles before and in the measured time, and the zones in which time and density are taken.
    int warmup_cycles = 1;
    int cycles = 5;
    std::vector<double> zone_radius_m = {};
    // Grids: what lies within this distance of the outer intersections' stop lines is measured; series are taken in steps of
    // `interval_s`; figures are means over the last `steady_s` of the run.
    double outside_m = 20.0;
    double interval_s = 60.0;
    double steady_s = 18000.0;
    double time_space_s = 0.0;             // of the end of the run: time-space diagram of one street
    std::string time_space_from = "west";  // west | east | south | north: the side from which that street is followed
};

struct Scenario {
    std::string name;
    std::string title;
    std::string fidelity = "full";  // full | meso
    double step_s = 0.01;           // of full dynamics; the mesoscale mode has its own
    double duration_s = 200.0;      // 0: as long as the measured cycles take
    std::uint64_t seed = 1;
    NetworkSettings network;
    SignalSettings signal;
    DemandSettings demand;
    std::string vehicle_name;  // file stem in data/vehicles
    std::string driver_name;   // file stem in data/drivers
    PowertrainSettings vehicle;
    DriverSettings driver;
    HindranceRules rules;
    MesoSettings meso;
    std::vector<GapPolicySettings> policies;      // all named policies that may be used
    std::vector<PopulationSettings> populations;  // one run each
    MeasureSettings measure;
    std::uint64_t hash = 0;  // of the canonical text of all fields; goes into provenance

    bool is_meso() const { return fidelity == "meso"; }
    double tick_s() const { return is_meso() ? meso.step_s : step_s; }
    // The same at all intersections; of an imported network the longest.
    double intersection_cycle_s() const;
    double longest_green_s() const;
};

}  // namespace stopline

// A scenario as loaded from YAML: complete, checked and in SI units. Plain data.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "demand/demand_settings.h"
#include "driver/driver_settings.h"
#include "driver/traffic_rules.h"
#include "network/network_settings.h"
#include "scenario/population_settings.h"
#include "signals/signal_controller.h"
#include "signals/signal_settings.h"
#include "vehicle/powertrain_settings.h"

namespace stopline {

inline constexpr const char* kNoBaseline = "none";

// An induction loop across one lane. It counts the vehicles whose front passes.
struct LoopSettings {
    std::string name;
    std::string lane;         // name of the lane in the lane graph
    double position_m = 0.0;  // from the start of the lane; below 0: from the stop line, or from the end without one
};

struct MeasureSettings {
    // For network.kind `approach` only: times after the start of green at which the passed vehicles are counted.
    std::vector<double> green_s;
    // Name of the population with which the others are compared; empty: none. Files can also give kNoBaseline for none.
    std::string baseline;
    // For network.kind `approach` only: off | on: measures whether accelerations grow along the queue.
    std::string string_stability = "off";
    // For single intersections only:
    int warmup_cycles = 1;  // signal cycles before the measurement
    int cycles = 5;         // measured signal cycles; follows from Scenario::duration_s if that is not 0
    std::vector<double> zone_radius_m = {};  // radii of the zones for travel time and density (measure.zones)
    // For all networks with intersections: a movement starves if the first vehicle of its queue has been stopped for
    // this time and for two cycles of its signal, although no vehicle ahead blocks its way. 0: never.
    double starvation_s = 300.0;
    std::string departure_delay = "off";   // off | on: report the times from arrival to entry
    std::string energy = "off";            // off | on: measure fuel, CO2 and electric energy
    std::string surrogate_safety = "off";  // off | on: measure comfort and surrogate safety
    std::string hcm = "off";               // off | on: report the lanes by the Highway Capacity Manual
    std::vector<LoopSettings> loops = {};  // for all networks but imported ones, which have loops in their files
    // For networks of several intersections only:
    double area_margin_m = 20.0;           // distance from the outer intersections to the boundary of the measured area
    double interval_s = 60.0;              // interval of the time series
    double window_s = 18000.0;             // length of the measuring window at the end of the run
    double time_space_s = 0.0;             // the time-space diagram shows this last part of the run; 0: no diagram
    std::string time_space_side = "west";  // side where the street of this diagram begins: west | east | south | north
};

struct Scenario {
    std::string name;
    std::string title;
    std::string fidelity = "full";  // full | meso
    double step_s = 0.01;           // time step of full dynamics; the mesoscale mode uses meso.step_s
    double duration_s = 200.0;      // 0: until the end of the measured cycles (single intersections only)
    std::uint64_t seed = 1;
    NetworkSettings network;
    SignalSettings signal;
    DemandSettings demand;
    std::string vehicle_name;  // name of the vehicle, by default its file name in data/vehicles without extension
    std::string driver_name;   // name of the driver, by default its file name in data/drivers without extension
    PowertrainSettings vehicle;
    DriverSettings driver;
    TrafficRules rules;
    MesoSettings meso;
    std::vector<GapPolicySettings> policies;      // all policies that a population may name
    std::vector<PopulationSettings> populations;  // one run is made for each of them
    MeasureSettings measure;
    std::uint64_t hash = 0;                  // result of scenario_hash()
    std::vector<std::string> warnings = {};  // warnings from loading, one line each, such as old names of fields

    bool is_meso() const { return fidelity == "meso"; }
    double tick_s() const { return is_meso() ? meso.step_s : step_s; }
    // Returns the nominal cycle of the intersections. For an imported network, returns the longest cycle and the
    // longest green of all signals.
    NominalCycle nominal_cycle() const;
    // Returns the time at which the run ends: duration_s, or the end of the measured cycles if that is 0.
    double end_s() const;
};

}  // namespace stopline

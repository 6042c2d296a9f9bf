// The constant data of a run, compiled from a scenario. Any number of runs and threads can share a Model.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "demand/demand_plan.h"
#include "driver/acceleration_laws.h"
#include "driver/krauss.h"
#include "network/detector.h"
#include "network/lane_graph.h"
#include "signals/programme.h"
#include "spacing_laws/gap_policy.h"
#include "vehicle/powertrain_tables.h"

namespace stopline {

struct CompiledPolicy {
    GapPolicySettings settings;
    const GapLaw* law = nullptr;
};

// A delay as samples of the past: the delayed value is interpolated between the sample `steps` steps ago and the sample
// before it. Results thus do not depend on the step length.
struct DelayLine {
    int steps = 0;       // whole steps of delay
    double share = 0.0;  // weight of the older sample
    int rows = 1;        // samples that must be kept
};
DelayLine make_delay(double delay_s, double step_s);

// The traffic rules (driver/traffic_rules.h) in ticks; 0 ticks: never.
struct RulesPlan {
    bool keep_clear = false;
    double sight_m = 0.0;
    bool count_queue_at_red_exit = false;
    std::int64_t teleport_ticks = 0;
    std::int64_t pass_blocker_ticks = 0;
    std::int64_t watch_ticks = 0;      // interval of delay attribution
    std::int64_t gridlock_ticks = 0;   // a gridlock observed again within this time continues
    std::int64_t long_wait_ticks = 0;  // a vehicle stopped for this long appears in the episodes whatever the cause
    std::int64_t memory_ticks = 0;     // a permission to pass a blocker expires this long after its last use

    bool watches() const { return watch_ticks > 0; }
};

struct Model {
    double step_s = 0.01;
    std::uint64_t seed = 1;
    LaneGraph graph;
    std::vector<std::vector<int>> connections_to;  // [lane] connections that lead to the lane
    std::vector<GroupProgramme> signals;           // [signal group]
    std::vector<PowertrainTables> vehicles;
    std::vector<CompiledPolicy> policies;
    DriverTables driver;
    std::int64_t hesitation_ticks = 0;  // reaction time of the first vehicle at a stop line to the start of green
    DemandPlan demand;
    std::vector<Detector> detectors;
    std::vector<std::string> loop_names;
    std::vector<double> area_begins_m;  // [lane] start of the measured area, 0 within it; empty: the whole network
    GiveWaySettings give_way;
    LaneChangeSettings lane_change;
    RulesPlan rules;
    DelayLine radar;
    DelayLine v2v;
    bool scalar_kernels = false;  // kernels treat one vehicle at a time and skip none, with the same results
    bool records_all = true;      // records passages, accepted gaps and all crossings; false: crossings of zones only
    bool records_detectors = false;  // records the crossings of all detectors although records_all is false
    // Detectors for the start and end of trips, at positions that no vehicle passes; -1: none.
    int trips_begin = -1;
    int trips_end = -1;
    // The mesoscale mode.
    bool meso = false;                // false: full dynamics
    std::vector<Krauss> krauss;       // [policy]
    double speed_factor = 1.0;        // of all speed limits
    double leader_speed_share = 1.0;  // share of that speed driven without a leader
    double approach_share = 1.0;      // share of the difference to the limit that a step closes
    double turn_share = 1.0;          // share of the difference to the speed profile before a turn that a step closes
    double leader_mps2 = 0.0;         // acceleration of platoon leaders; 0: that of the policy's model
    double leader_constant_power_speed_mps = 0.0;  // speed above which that acceleration falls
    LeaderProfile leader_profile;                  // replaces the two values above if it has bins
    int start_relay_vehicles = 0;                  // stopped vehicles that a start message reaches in one step

    double time_s(std::int64_t tick) const { return static_cast<double>(tick) * step_s; }
};

// Throws InputError if the parts of the model contradict each other.
void check(const Model& model);

}  // namespace stopline

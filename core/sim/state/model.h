// The constant data of a run, compiled from a scenario. Any number of runs and threads can share a Model.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "base/containers/packed_lists.h"
#include "demand/demand_plan.h"
#include "driver/acceleration_laws.h"
#include "driver/acceleration_profile.h"
#include "driver/following_model.h"
#include "network/detector.h"
#include "network/lane_graph.h"
#include "signals/phase_priority.h"
#include "signals/signal_plan.h"
#include "spacing_laws/gap_policy.h"
#include "v2v/plan.h"
#include "vehicle/powertrain_tables.h"

namespace stopline {

// The time lag of a sensor or of V2V messages. It is realised by storing samples of past steps. The delayed value is
// interpolated between the sample of `steps` steps ago and the sample of one step before that. The lag thus need not be
// a whole number of steps.
struct DelayLine {
    int steps = 0;       // number of whole steps in the delay
    double share = 0.0;  // weight of the older sample
    int rows = 1;        // number of samples that must be stored
};
// Returns the delay line that realises a delay.
DelayLine make_delay(double delay_s, double step_s);

// The traffic rules (driver/traffic_rules.h) with all times in ticks. A rule with a time of 0 ticks never applies.
struct RulesPlan {
    bool keep_clear = false;
    double sight_m = 0.0;
    bool count_queue_at_red_exit = false;
    bool clearing = false;  // cooperative clearing
    std::int64_t teleport_ticks = 0;
    std::int64_t pass_blocker_ticks = 0;
    // Interval at which the delays of stopped vehicles are attributed to causes; 0: never.
    std::int64_t watch_ticks = 0;
    // A gridlock ends when it has not been observed for this time. A later observation counts as a new gridlock.
    std::int64_t gridlock_ticks = 0;
    // Signals, yielding and queue discharge cause many short stops. A delay episode (DelayEpisode) with such a cause
    // includes only vehicles that have been stopped for this time. Episodes with other causes include all stopped
    // vehicles.
    std::int64_t long_wait_ticks = 0;
    // Stop duration after which the first vehicle of an unblocked queue counts as starving (Starvation in delay_log.h).
    // 0: never.
    std::int64_t starvation_ticks = 0;
    // The permission to pass a blocker (BlockerPass) expires when it has not been needed for this time.
    std::int64_t memory_ticks = 0;

    bool watches() const { return watch_ticks > 0; }
};

// A driver, prepared for the simulation.
struct DriverPlan {
    DriverTables tables;
    GiveWaySettings give_way;
    LaneChangeSettings lane_change;
    HumanSettings human;
    SpeedAdviceSettings speed_advice;
    bool is_human = false;  // true: a human driver (driver/human.h); false: an automated vehicle
    // Values of lane_change and speed_advice that a step would have to derive from texts.
    bool looks_ahead = true;  // chooses lanes for the turn after the next one
    GapOpening gap_opening = GapOpening::on;
    bool has_speed_advice = false;
    // Reaction time of the first vehicle at a stop line when its signal turns green.
    double hesitation_s = 0.0;
    std::int64_t hesitation_ticks = 0;  // the same in ticks
};

// The vehicle type and the driver of the vehicles with one spacing policy.
struct VehicleClass {
    int vehicle = 0;  // index in Model::vehicles
    int driver = 0;   // index in Model::drivers
};

struct Model {
    double step_s = 0.01;
    std::uint64_t seed = 1;
    LaneGraph graph;
    PackedLists<int> connections_to;              // [lane] connections that lead to the lane
    SignalPlans signals;                          // one for each intersection
    std::vector<PhasePriority> phase_priorities;  // right of way that changes at fixed times
    std::vector<PriorityByPhase>
        priorities_by_phase;                 // right of way of signals with phases, in the order of the signals
    std::vector<PowertrainTables> vehicles;  // the vehicle types of the population
    // The drivers of the population. A driver of several vehicle types has a plan for each type.
    std::vector<DriverPlan> drivers;
    // [policy] Each component of the population has a policy of its own. If the vehicle types of SUMO's files apply,
    // each pair of component and vehicle type has one.
    std::vector<GapPolicy> policies;
    std::vector<VehicleClass> classes;  // [policy]
    DemandPlan demand;
    std::vector<Detector> detectors;
    std::vector<std::string> loop_names;
    std::vector<double> area_begins_m;  // [lane] position where the measured area begins; empty: all lanes are measured
    RulesPlan rules;
    // Age of the radar data when the driver computes the requested acceleration. This acceleration takes
    // effect one step later. The radar delay of the settings ends only then, so the age is that delay minus one step.
    DelayLine radar;
    DelayLine v2v;
    V2vPlan v2v_plan;  // V2V channel; by default it is not active, and every message arrives after the delay `v2v`
    // true: the kernels compute one vehicle at a time and do not skip standing queues. The results are the same.
    bool scalar_kernels = false;
    // true: record passages, accepted gaps, and the crossings of all detectors; false: only the crossings of zones
    // (Detector::Kind::zone) and of the two detectors that stand for trip starts and ends (trips_begin, trips_end)
    bool records_all = true;
    bool records_detectors = false;  // true: record the crossings of all detectors even if records_all is false
    // Indices of the two detectors that stand for the start and the end of a trip. They are on no lane. -1: none.
    int trips_begin = -1;
    int trips_end = -1;
    bool has_speed_advice = false;    // true: some drivers get speed advice from signals
    bool has_speed_limiters = false;  // true: the maximum speed of some vehicles is below the speed limit of a lane
    // Settings of the mesoscale mode.
    bool meso = false;                      // true: mesoscale mode; false: full dynamics
    std::vector<FollowingModel> following;  // [policy] car-following model
    double speed_factor = 1.0;              // factor by which all speed limits are multiplied
    double leader_speed_share = 1.0;        // a vehicle without a leader drives at this share of the speed limit
    // Below the speed limit, the speed rises in one step by at most this share of (speed limit - speed).
    double approach_share = 1.0;
    // Before a lower speed limit, such as that of a turn, vehicles follow a braking curve: at each position, the speed
    // from which moderate braking just suffices. In each step, a vehicle corrects this share of the difference between
    // its speed and the curve (MesoStep in mesoscale/meso_kernels.h).
    double turn_share = 1.0;
    double leader_mps2 = 0.0;  // acceleration of platoon leaders; 0: acceleration of the policy's car-following model
    double leader_constant_power_speed_mps = 0.0;  // above this speed, leader_mps2 falls as 1 / speed
    // The accelerations of `following` and of platoon leaders are calibrated for lanes on which the speed limit times
    // speed_factor is at most this value.
    double calibrated_limit_mps = 1e9;
    bool has_fast_lanes = false;  // true: on some lanes, limit times speed_factor exceeds calibrated_limit_mps
    // [policy] highest accelerations of the vehicles; empty: the car-following models alone limit the accelerations.
    std::vector<AccelerationProfile> acceleration_limits;
    // Mesoscale mode: [policy] deceleration before a lower speed limit; empty if all drivers have the same.
    std::vector<double> slow_downs_mps2;
    double powertrain_delay_s = 0.0;  // mesoscale mode: start-up delay of a vehicle (MesoSettings::start_delay_s)
    // Lower bound of the acceleration by speed, on the lanes that has_fast_lanes means.
    AccelerationProfile power_profile;
    // Acceleration of platoon leaders by speed. If this table is not empty (bins_per_mps above 0), it replaces
    // leader_mps2 and leader_constant_power_speed_mps.
    AccelerationProfile leader_profile;
    // Largest number of stopped vehicles that one V2V start message (StartMessage in partition.h) reaches in a step. 0:
    // no messages.
    int start_relay_vehicles = 0;

    // Returns true if the network is imported from SUMO files. Only imported networks have trips.
    bool is_imported() const { return !demand.trips.empty(); }
    bool has_human_drivers() const {
        return std::any_of(drivers.begin(), drivers.end(), [](const DriverPlan& driver) { return driver.is_human; });
    }
    // Returns the driver of the vehicles with a spacing policy.
    const DriverPlan& driver_of(int policy) const {
        return drivers[drivers.size() == 1
                           ? 0
                           : static_cast<std::size_t>(classes[static_cast<std::size_t>(policy)].driver)];
    }
    // Returns the type of the vehicles with a spacing policy.
    const PowertrainTables& vehicle_of(int policy) const {
        return vehicles[static_cast<std::size_t>(classes[static_cast<std::size_t>(policy)].vehicle)];
    }
    // Returns the first driver of the population. Only for settings in which all drivers agree: check_fleets()
    // (scenario/fleets.h) ensures that they do. Exception: power_profile, which is that of this driver. In mixed
    // populations, acceleration_limits bounds the accelerations of the other vehicles.
    const DriverTables& common_driver() const { return drivers.front().tables; }

    double time_s(std::int64_t tick) const { return static_cast<double>(tick) * step_s; }
};

// Throws InputError if the parts of the model contradict each other.
void check(const Model& model);

}  // namespace stopline

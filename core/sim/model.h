// Everything of a run that does not change: compiled once, then constant and shared by any number of runs and threads.
#pragma once

#include <cstdint>
#include <vector>

#include "demand/demand_plan.h"
#include "driver/acceleration_laws.h"
#include "driver/gap_policy.h"
#include "driver/krauss.h"
#include "network/lane_graph.h"
#include "signals/programme.h"
#include "vehicle/powertrain_tables.h"

namespace stopline {

// A spacing policy ready for use.
struct CompiledPolicy {
    GapPolicySettings settings;
    const GapLaw* law = nullptr;
};

// A delay as samples of the past: the value `steps` steps ago and the one before it, mixed by `share`. Delays that are no
// multiple of the step are thus interpolated, and results do not depend on the step.
struct DelayLine {
    int steps = 0;       // whole steps of delay
    double share = 0.0;  // weight of the sample one step older
    int rows = 1;        // samples that must be kept
};
DelayLine make_delay(double delay_s, double step_s);

// Where passing fronts are noted.
struct Detector {
    enum class Kind : std::uint8_t {
        stop_line,
        zone,
        exit,
        middle,
        loop
    };  // exit: behind an intersection; middle: of a link; loop: where the scenario has one, by name
    int lane = -1;
    double position_m = 0.0;
    Kind kind = Kind::stop_line;
    int zone = -1;        // index of the zone that it bounds
    bool leaves = false;  // whether vehicles leave the zone here
    int loop = -1;        // its name, of Model::loop_names
};

// Rules of hindrance (driver/hindrance_rules.h), compiled; 0 ticks: never.
struct RulesPlan {
    bool keep_clear = false;
    double sight_m = 0.0;
    bool minds_light_ahead = false;
    std::int64_t teleport_ticks = 0;
    std::int64_t pass_blocker_ticks = 0;
    std::int64_t watch_ticks = 0;      // hindrance is looked for this often
    std::int64_t gridlock_ticks = 0;   // a circle that is seen again within this goes on
    std::int64_t long_wait_ticks = 0;  // who has stood so long is told of in any case
    std::int64_t memory_ticks = 0;     // who may pass a blocker may, until this long after it mattered last

    bool watches() const { return watch_ticks > 0; }
};

struct Model {
    double step_s = 0.01;
    std::uint64_t seed = 1;
    LaneGraph graph;
    std::vector<std::vector<int>> leads_to;  // [lane] lanes inside an intersection that lead to it
    std::vector<GroupProgramme> signals;     // [signal group]
    std::vector<PowertrainTables> vehicles;
    std::vector<CompiledPolicy> policies;
    DriverTables driver;
    std::int64_t hesitation_ticks = 0;  // first vehicle at a stop line, after the start of green
    DemandPlan demand;
    std::vector<Detector> detectors;
    std::vector<std::string> loop_names;
    std::vector<double> area_begins_m;  // [lane] where the measured area does, 0 within it; empty: all is measured
    GiveWaySettings give_way;
    LaneChangeSettings lane_change;
    RulesPlan rules;
    DelayLine radar;
    DelayLine v2v;
    bool meso = false;            // the mesoscale mode; else full dynamics
    std::vector<Krauss> krauss;   // [policy], mesoscale mode
    double speed_factor = 1.0;    // of all limits, mesoscale mode
    double leader_share = 1.0;    // of that, for vehicles without a predecessor
    double approach_share = 1.0;  // of what is missing to the limit, gained in a step
    double turn_share = 1.0;      // of what is missing to what the way to a turn allows
    double leader_mps2 = 0.0;     // acceleration of platoon leaders, up to a speed; 0: that of their policy's model
    double leader_until_mps = 0.0;
    LeaderProfile leader_profile;  // instead of these two, where it has bins
    int relayed = 0;               // vehicles at rest that hear at once that those ahead set out, mesoscale mode
    // Detectors that stand for where trips begin and end, wherever that is; -1: none. They lie where nobody passes them.
    int trips_begin = -1;
    int trips_end = -1;
    bool records_all = true;         // passages, accepted gaps, all detectors; else crossings of zones only
    bool records_detectors = false;  // crossings of all detectors even so
    bool scalar_kernels = false;     // the oracle: one vehicle at a time, none left out, same bits

    double time_s(std::int64_t tick) const { return static_cast<double>(tick) * step_s; }
};

// Throws InputError where the parts do not fit together; to be called once after a Model has been put together.
void check(const Model& model);

}  // namespace stopline

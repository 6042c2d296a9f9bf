// The report of a signal by the Highway Capacity Manual (HCM, 6th edition, chapters 19 and 31): saturation flow,
// capacity, control delay, stops, back of queue and level of service of each lane. Measured delays and queues come with
// the values of the HCM formulas.
//
// Control delay is the travel time minus the time at free-flow speed. It begins when a vehicle enters the lane of the
// stop line, or when it slows for this signal if it still accelerates from the last one. It ends when the vehicle
// reaches kFreeFlowShare of its free-flow speed beyond the stop line. The free-flow speed on a connection is the limit
// of the connection, so that slow driving inside a turn is no delay.
//
// All values of a lane cover whole cycles of its signal within the window. The cycles of a lane follow those of
// the controller. So the lanes of a signal have almost the same number of cycles. They differ only by the cycles that
// cross an end of the window:
//   - A green belongs to the cycle of the signal in which it ends. The cycle of the lane lasts until the red after its
//     last green begins.
//   - A controller can skip the phase of a lane. The lane then has a cycle without green, which lasts until the next
//     cycle of the signal begins.
//   - A green can last through a whole cycle of the signal. The cycle of the lane then ends with that of the signal.
// An external controller has no cycle. A red and the green after it then count as one cycle.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "measure/discharge.h"
#include "measure/zones.h"
#include "network/lane_graph.h"

namespace stopline {

inline constexpr double kFreeFlowShare = 0.99;

// A vehicle that has passed a stop line.
struct HcmPassage {
    double time_s = 0.0;
    double delay_s = 0.0;  // control delay
    int stops = 0;
    bool has_queued = false;
};

// Part of the record of a lane: a red and the green after it, up to the next red. A cycle of the signal can have
// several intervals, such as a protected and a permissive green of a left turn. An interval without green is a cycle in
// which the controller skips the lane. If the cycle of the signal ends within a green, the interval ends there. The
// next one then begins with the rest of this green.
struct HcmInterval {
    double from_s = 0.0;
    double to_s = 0.0;
    double green_from_s = 0.0;
    double green_to_s = 0.0;      // equal to green_from_s: no green
    int back_veh = 0;             // vehicles in the queue at the start of red, and vehicles that joined it later
    double back_m = 0.0;          // greatest distance from the stop line to the rear of a queued vehicle
    int residual_veh = 0;         // queued vehicles that have not passed at the end of the interval
    int present_veh = 0;          // vehicles before the stop line at the end, with those that wait to enter
    bool is_used = false;         // queued vehicles are left at the end of green
    int residual_before_veh = 0;  // residual_veh and present_veh at the start of the interval
    int present_before_veh = 0;
    // Number of the cycle of the signal in which the green ends. Intervals with the same number are one cycle of the
    // lane. -1: the interval is a cycle of its own.
    std::int64_t cycle = -1;
    int teleported_veh = 0;      // vehicles that a teleport removed before the stop line
    bool green_goes_on = false;  // the cycle ends within a green; the rest of this green is in the next interval

    bool has_green() const { return green_to_s > green_from_s; }
};

// The record of a lane during a run.
struct HcmRecord {
    int lane = -1;
    std::string approach;
    std::string intersection;
    bool has_endless_demand = false;     // a vehicle always waits to enter the lane
    std::int64_t first_cycle = -1;       // number of the cycle in which the first interval begins; -1: not known
    std::int64_t last_cycle = -1;        // number of the cycle in which the record ends; -1: not known
    std::vector<HcmInterval> intervals;  // in order of time, without gaps
    std::vector<HcmPassage> passages;    // in order of time
    std::vector<double> green_starts_s;
};

// The flow through a lane or an approach compared with its capacity.
//   free           the queue clears in most cycles
//   saturated      in half of the cycles or more, a part of the queue does not pass
//   oversaturated  demand exceeds capacity, and the queue grows or is cut off by the length of the lane
enum class HcmState : unsigned char { free, saturated, oversaturated };
const char* hcm_state_name(HcmState state);

// A lane, an approach or an intersection. Approaches and intersections have only counts, flows, delays and stops.
struct HcmRow {
    enum class Scope : unsigned char { lane, approach, intersection };
    Scope scope = Scope::lane;
    std::string name;
    std::string approach;
    std::string intersection;
    int cycles = 0;
    double cycle_s = 0.0;
    double green_s = 0.0;  // sum over the greens of a cycle
    double greens_per_cycle = 0.0;
    bool has_several_greens = false;  // in at least one cycle
    LaneDischarge discharge;
    int used_greens = 0;                 // greens for which the queue lasts
    double saturation_flow_veh_h = 0.0;  // fewer than kMinGreens saturated greens: mean of all lanes
    double startup_lost_time_s = 0.0;    // the same
    double end_gain_s = 0.0;             // fewer than kMinGreens used greens: mean of all lanes, or kEndGain_s
    double effective_green_s = 0.0;
    double capacity_veh_h = 0.0;
    double volume_veh_h = 0.0;  // vehicles that arrive
    double passed_veh_h = 0.0;  // vehicles that pass the stop line
    double saturation = 0.0;    // degree of saturation X, volume over capacity
    double control_delay_s = 0.0;
    // Values of the formula. They hold for one green in a cycle: NaN for lanes that have more in any cycle.
    double uniform_delay_s = 0.0;        // d1
    double incremental_delay_s = 0.0;    // d2
    double initial_queue_delay_s = 0.0;  // d3
    double stops = 0.0;                  // per vehicle
    double back_50_veh = 0.0, back_95_veh = 0.0, back_50_m = 0.0, back_95_m = 0.0;
    double formula_back_50_veh = 0.0, formula_back_95_veh = 0.0;
    double residual_share = 0.0;  // share of cycles in which a part of the queue does not pass, 0 .. 1
    double initial_queue_veh = 0.0;
    HcmState state = HcmState::free;
    bool has_endless_demand = false;
    char level = '-';          // level of service of the measured delay; '-': no vehicle
    char formula_level = '-';  // level of service of the delay by the formula

    double formula_delay_s() const { return uniform_delay_s + incremental_delay_s + initial_queue_delay_s; }
};

// End gain if too few queues last until the end of green (HCM, 6th edition, chapter 19: extension of the effective
// green, e).
inline constexpr double kEndGain_s = 2.0;

// A lane with fewer saturated greens than this gets saturation flow and lost time as means of all lanes. The same holds
// for the end gain and the greens for which the queue lasts.
inline constexpr int kMinGreens = 5;

// Returns the value below which `share` of the values lie, with linear interpolation between neighbours. NaN: no
// values.
double percentile(std::vector<double> values, double share);

// Returns the rows of the lanes, then of the approaches, then of the intersections. Lanes without a whole cycle in the
// window, and lanes whose green never ends in the record, have no row.
std::vector<HcmRow> hcm_rows(const LaneGraph& graph, const std::vector<HcmRecord>& records, const TimeWindow& window);

}  // namespace stopline

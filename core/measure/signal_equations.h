// Closed forms for a fixed-time signal: Webster's cycle and greens, and capacity, delay and level of service by the
// Highway Capacity Manual (HCM). Pure functions; times in s, flows in veh/h.
//
// Sources:
//   Webster      F. V. Webster, Traffic Signal Settings, Road Research Technical Paper 39, London 1958
//   HCM          Highway Capacity Manual 2000, chapter 16. The 6th edition, chapter 19, keeps these equations.
//   MUTCD        Manual on Uniform Traffic Control Devices 2009, section 4E.06
#pragma once

#include <span>
#include <vector>

namespace stopline {

// Webster's equations diverge as the sum of the critical flow ratios approaches 1. From this sum on they give no cycle.
inline constexpr double kMaxFlowRatioSum = 0.95;

// Ratio of the demand of a lane to its saturation flow (HCM equation 16-7 with X g / C). Throws InputError unless the
// saturation flow is above 0.
double flow_ratio(double demand_veh_h, double saturation_flow_veh_h);

// Returns Webster's cycle of least delay, C = (1.5 L + 5 s) / (1 - Y). `lost_time_s` L is the lost time of all stages
// in a cycle, and `flow_ratio_sum` Y is the sum of the critical flow ratios of the stages. Throws InputError if Y is
// kMaxFlowRatioSum or more.
double webster_cycle_s(double lost_time_s, double flow_ratio_sum);

// Returns the effective greens of the stages: the cycle without its lost time, shared in proportion to the critical
// flow ratios (Webster). All ratios 0: equal shares.
std::vector<double> effective_greens_s(double cycle_s, double lost_time_s, std::span<const double> flow_ratios);

// Returns the green that pedestrians need to cross a road: a walk interval of 7 s, then the crossing at 1.07 m/s
// (3.5 ft/s), of which yellow and all red may cover the end (MUTCD).
double pedestrian_green_s(double crossing_m, double yellow_s, double all_red_s);

// Returns the capacity s g / C (HCM equation 16-6).
double capacity_veh_h(double saturation_flow_veh_h, double effective_green_s, double cycle_s);

// Returns the uniform delay d1 (HCM equation 16-11), the delay of evenly spaced arrivals. `saturation` is the degree of
// saturation X, demand over capacity.
double uniform_delay_s(double cycle_s, double effective_green_s, double saturation);

inline constexpr double kHcmPeriod_h = 0.25;    // analysis period of 15 min
inline constexpr double kPretimedSignal = 0.5;  // factor k of a pretimed signal

// Returns the incremental delay d2 (HCM equation 16-12) of random arrivals and of demand above capacity. `variance_i`
// is the factor I: the variance of the arrivals in a cycle over their mean. The defaults are an analysis period of 15
// min, a pretimed signal, and an isolated intersection, whose arrivals are random (I = 1).
double incremental_delay_s(double saturation, double capacity_veh_h, double period_h = kHcmPeriod_h,
                           double k = kPretimedSignal, double variance_i = 1.0);

// Returns the delay d3 that a queue at the start of the analysis period causes (HCM, 6th edition, chapter 19). Volume
// and capacity stay constant in the period. `queue_veh` is this queue.
//
// The queue lasts until the spare capacity has discharged it. Each arrival waits until the capacity has discharged what
// is left of it. The mean over the arrivals equals the equation of the HCM, which divides by the volume. In this form
// it is also defined without volume. It is then the mean delay that a single arrival at any time would have.
double initial_queue_delay_s(double queue_veh, double volume_veh_h, double capacity_veh_h, double period_h);

// The back of the queue of a lane: the vehicles that stop in a cycle, and those that the last cycle has left. The first
// term Q1 is that of HCM 2000, chapter 16, appendix G, for random arrivals. The second and third term and the factor
// for percentiles are those of the 6th edition, chapter 31.
struct BackOfQueue {
    double volume_veh_h = 0.0;
    double capacity_veh_h = 0.0;
    double cycle_s = 0.0;
    double effective_green_s = 0.0;
    double incremental_delay_s = 0.0;    // d2
    double initial_queue_delay_s = 0.0;  // d3

    double first_term_veh() const;
    double second_term_veh() const { return incremental_delay_s * capacity_veh_h / 3600.0; }
    double third_term_veh() const { return initial_queue_delay_s * volume_veh_h / 3600.0; }
    // Returns the queue that is not exceeded with the probability of the quantile `z` of the normal distribution. z =
    // 0: the mean queue.
    double percentile_veh(double z) const;
};

// Returns the level of service, A to F, of a control delay (HCM exhibit 16-2). It is F for any degree of saturation
// above 1 (HCM, 6th edition, exhibit 19-8).
char level_of_service(double control_delay_s, double saturation);

}  // namespace stopline

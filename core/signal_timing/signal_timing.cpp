#include "signal_timing/signal_timing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "base/nan.h"
#include "measure/signal_equations.h"
#include "runs/parallel_runs.h"
#include "scenario/build_model.h"
#include "scenario/files/field_place.h"
#include "scenario/kinds/network_kind.h"

namespace stopline {

namespace {

bool is_timed_kind(const NetworkSettings& network) { return network.kind == "intersection" || network.kind == "grid"; }

// Returns, for each stage and place, the lane with the most demand.
std::vector<LaneTiming> busiest_lanes(const std::vector<LaneDemand>& demands, const Saturation& saturation) {
    std::vector<LaneTiming> lanes;
    for (const LaneSaturation& measured : saturation.lanes) {
        LaneTiming lane;
        for (const LaneDemand& one : demands) {
            if (one.stage != measured.stage || one.index != measured.index) continue;
            if (lane.demand.lane.empty() || one.flow_veh_h > lane.demand.flow_veh_h) lane.demand = one;
        }
        lane.saturation_flow_veh_h = measured.flow_veh_h;
        lane.capacity_variance_ratio = measured.capacity_variance_ratio;
        lane.flow_ratio = flow_ratio(lane.demand.flow_veh_h, measured.flow_veh_h);
        lanes.push_back(std::move(lane));
    }
    return lanes;
}

void mark_critical_lanes(PopulationTiming& timing) {
    for (int stage = 0; stage < kTimingStages; ++stage) {
        LaneTiming* critical = nullptr;
        for (LaneTiming& lane : timing.lanes) {
            if (lane.demand.stage != stage) continue;
            if (critical == nullptr || lane.flow_ratio > critical->flow_ratio) critical = &lane;
        }
        critical->is_critical = true;
        timing.critical_ratio[at(stage)] = critical->flow_ratio;
    }
}

// Sets what the HCM predicts for each lane with the times of the signal. If the capacity changes from cycle to cycle,
// its variance adds to that of the arrivals. The mean queue in heavy traffic grows with the sum of both (J. F. C.
// Kingman, On queues in heavy traffic, J. Royal Statistical Society B 24, 1962). So the factor I of the HCM, which is
// the ratio of variance and mean of the arrivals, becomes the sum of both ratios.
void predict(PopulationTiming& timing) {
    double delay_s = 0.0;
    double demand_veh_h = 0.0;
    for (LaneTiming& lane : timing.lanes) {
        const std::size_t stage = at(lane.demand.stage);
        const double green_s = timing.saturation.lost[stage].effective_green_s(timing.times.green_s[stage]);
        lane.capacity_veh_h = capacity_veh_h(lane.saturation_flow_veh_h, green_s, timing.cycle_s);
        lane.saturation = lane.demand.flow_veh_h / lane.capacity_veh_h;
        lane.uniform_delay_s = uniform_delay_s(timing.cycle_s, green_s, lane.saturation);
        lane.incremental_delay_s = incremental_delay_s(lane.saturation, lane.capacity_veh_h, kHcmPeriod_h,
                                                       kPretimedSignal, 1.0 + lane.capacity_variance_ratio);
        delay_s += lane.demand.flow_veh_h * lane.delay_s();
        demand_veh_h += lane.demand.flow_veh_h;
    }
    timing.delay_s = delay_s / demand_veh_h;
}

void mark_oversaturated(PopulationTiming& timing) {
    timing.webster_cycle_s = timing.cycle_s = timing.delay_s = timing.times.offset_s = kNan;
    timing.times.green_s.fill(kNan);
    for (LaneTiming& lane : timing.lanes) {
        lane.capacity_veh_h = lane.saturation = lane.uniform_delay_s = lane.incremental_delay_s = kNan;
    }
}

// Returns the offset with which a vehicle that drives at the speed limit meets green at each intersection of a row.
double progression_offset_s(const Scenario& scenario) {
    const GridSettings& grid = scenario.network.grid;
    if (scenario.network.kind != "grid" || grid.columns * grid.rows == 1) return 0.0;
    const double spacing_m = grid.columns > 1 ? grid.column_spacing_m : grid.row_spacing_m;
    return std::round(spacing_m / scenario.network.intersection.speed_limit_mps);
}

}  // namespace

bool PopulationTiming::is_oversaturated() const { return flow_ratio_sum >= kMaxFlowRatioSum; }

double PopulationTiming::highest_saturation() const {
    double highest = 0.0;
    for (const LaneTiming& lane : lanes) highest = std::max(highest, lane.saturation);
    return highest;
}

void check_timing_scenario(const Scenario& scenario, const std::string& file,
                           const std::vector<std::string>& overrides) {
    const auto refuse = [&](const std::string& field, const std::string& problem) {
        throw InputError(fmt::format("{}: field '{}': {}", field_place(file, overrides, field), field, problem));
    };
    if (!is_timed_kind(scenario.network)) {
        refuse("network.kind",
               fmt::format("value '{}' has no start values here (allowed: intersection, grid)", scenario.network.kind));
    }
    if (scenario.demand.kind != "rate") {
        refuse(
            "demand.kind",
            fmt::format("value '{}' is not supported by stopline-signals (allowed: rate). Try --set demand.kind=rate "
                        "--set demand.start=empty --set 'demand.inflow=600 veh/h'",
                        scenario.demand.kind));
    }
    const auto has_inflow = [](const ProfilePoint& point) { return point.inflow > 0.0; };
    const std::vector<ProfilePoint>& profile = scenario.demand.profile;
    if (!profile.empty() && std::none_of(profile.begin(), profile.end(), has_inflow)) {
        refuse("demand.profile", "all factors are 0 %, so there is no demand to time a signal for");
    }
    if (!scenario.signal.phases.empty())
        refuse("signal.phases", "stopline-signals does not support phases: leave them out");
    if (!scenario.signal.programmes.empty()) {
        refuse("signal.programmes", "stopline-signals does not support programmes: leave them out");
    }
    if (scenario.signal.controller != "fixed_time") {
        refuse("signal.controller",
               fmt::format("value '{}' has no start values (allowed: fixed_time)", scenario.signal.controller));
    }
}

std::array<double, kTimingStages> shortest_greens_s(const Scenario& scenario, const TimingOptions& options) {
    std::array<double, kTimingStages> greens_s{};
    greens_s.fill(std::ceil(options.min_green_s));
    if (!options.pedestrians) return greens_s;
    // Pedestrians have green together with the vehicles parallel to them, and cross all lanes of a leg.
    const IntersectionSettings& layout = scenario.network.intersection;
    const double crossing_m = 2.0 * static_cast<double>(layout.lanes.size()) * layout.lane_width_m;
    const double green_s = pedestrian_green_s(crossing_m, scenario.signal.yellow_s, scenario.signal.all_red_s);
    for (double& green : greens_s) green = std::max(green, std::ceil(green_s));
    return greens_s;
}

PopulationTiming timing_of(const Scenario& scenario, const std::vector<LaneDemand>& demands,
                           const Saturation& saturation, const TimingOptions& options) {
    PopulationTiming timing;
    timing.saturation = saturation;
    timing.lanes = busiest_lanes(demands, saturation);
    mark_critical_lanes(timing);
    const SignalSettings& signal = scenario.signal;
    double lost_s = 0.0;
    for (int stage = 0; stage < kTimingStages; ++stage) {
        timing.lost_time_s[at(stage)] = saturation.lost[at(stage)].total_s(signal.yellow_s, signal.all_red_s);
        lost_s += timing.lost_time_s[at(stage)];
        timing.flow_ratio_sum += timing.critical_ratio[at(stage)];
    }
    if (timing.is_oversaturated()) {
        mark_oversaturated(timing);
        return timing;
    }
    timing.webster_cycle_s = webster_cycle_s(lost_s, timing.flow_ratio_sum);
    const std::vector<double> greens_s = effective_greens_s(timing.webster_cycle_s, lost_s, timing.critical_ratio);
    const std::array<double, kTimingStages> shortest_s = shortest_greens_s(scenario, options);
    for (std::size_t stage = 0; stage < kTimingStages; ++stage) {
        const double green_s = std::round(saturation.lost[stage].displayed_green_s(greens_s[stage]));
        timing.times.green_s[stage] = std::max(green_s, shortest_s[stage]);
        timing.cycle_s += timing.times.green_s[stage] + signal.yellow_s + signal.all_red_s;
    }
    timing.times.offset_s = progression_offset_s(scenario);
    predict(timing);
    return timing;
}

namespace {

// Returns the demand of all lanes. A profile of the inflow counts with its highest factor.
std::vector<LaneDemand> peak_demands(const Scenario& scenario, std::size_t population) {
    std::vector<LaneDemand> demands = lane_demands(build_model(scenario, population));
    if (scenario.demand.profile.empty()) return demands;
    double peak = 0.0;
    for (const ProfilePoint& point : scenario.demand.profile) peak = std::max(peak, point.inflow);
    for (LaneDemand& one : demands) one.flow_veh_h *= peak;
    return demands;
}

// Measures a population with the greens of its timing, until both agree.
PopulationTiming time_population(const Scenario& scenario, std::size_t population, const TimingOptions& options,
                                 const std::function<bool(double)>& report) {
    constexpr int kRounds = 8;         // the greens of some populations alternate between two values
    constexpr double kClose_s = 1.01;  // greens are whole seconds
    SaturationInput input;
    input.demands = peak_demands(scenario, population);
    PopulationTiming timing;
    for (int round = 0; round < kRounds; ++round) {
        const auto report_round = [&](double share) { return report((round + share) / kRounds); };
        const Saturation saturation = measure_saturation(scenario, population, input, report_round);
        timing = timing_of(scenario, input.demands, saturation, options);
        if (timing.is_oversaturated()) break;
        const StageGreens& greens_s = timing.times.green_s;
        timing.greens_agree = std::abs(greens_s[0] - input.greens_s[0]) < kClose_s &&
                              std::abs(greens_s[1] - input.greens_s[1]) < kClose_s;
        if (timing.greens_agree) break;
        input.greens_s = greens_s;
        input.earlier = &timing.saturation;
    }
    return timing;
}

}  // namespace

std::vector<PopulationTiming> time_signals(const Scenario& scenario, const TimingOptions& options) {
    std::vector<PopulationTiming> timings(scenario.populations.size());
    run_side_by_side(timings.size(), options.threads, options.on_progress,
                     [&](std::size_t population, const std::function<bool(double)>& report) {
                         timings[population] = time_population(scenario, population, options, report);
                     });
    return timings;
}

}  // namespace stopline

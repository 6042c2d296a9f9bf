#include "signal_timing/saturation_run.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "base/nan.h"
#include "measure/confidence.h"
#include "network/side.h"
#include "runs/interrupted.h"
#include "runs/intersection/intersection_run.h"
#include "scenario/build_model.h"
#include "sim/step/simulation.h"

namespace stopline {

namespace {

// Part of yellow that drivers use if no lane measures it (HCM 2000, exhibit 10-12: 2 s).
constexpr double kUsualEndGain_s = 2.0;

// Counts the vehicles that pass each stop line in each of several successive cycles.
class PassageCounter {
public:
    PassageCounter(const LaneGraph& graph, double from_s, double cycle_s, int cycles)
        : passed_(graph.lanes.size(), std::vector<double>(at(cycles), 0.0)), from_s_(from_s), cycle_s_(cycle_s) {}

    // Reads the crossings that have been recorded since the last call.
    void read(const Simulation& simulation) {
        const std::vector<Crossing>& crossings = simulation.state().records.crossings;
        for (; read_ < crossings.size(); ++read_) {
            const Detector& detector = simulation.model().detectors[at(crossings[read_].detector)];
            if (detector.kind != Detector::Kind::stop_line) continue;
            const double cycle = std::floor((crossings[read_].time_s - from_s_) / cycle_s_);
            std::vector<double>& of_lane = passed_[at(detector.lane)];
            if (cycle >= 0.0 && cycle < static_cast<double>(of_lane.size())) ++of_lane[static_cast<std::size_t>(cycle)];
        }
    }
    // Returns the vehicles that pass the stop line of a lane in each cycle.
    const std::vector<double>& in_cycles(std::size_t lane) const { return passed_[lane]; }

private:
    std::vector<std::vector<double>> passed_;  // [lane][cycle]
    double from_s_;
    double cycle_s_;
    std::size_t read_ = 0;
};

// Values of the lanes that one LaneSaturation averages.
struct LaneSums {
    std::vector<double> vehicles_per_green;
    std::vector<double> saturation_headway_s;
    std::vector<double> startup_lost_time_s;
};

double mean_or_nan(const std::vector<double>& values) { return values.empty() ? kNan : mean_of(values); }

// Sets the headways and start-up lost times of the lanes of a stage. Those that the run does not have are of an earlier
// measurement.
void set_headways(std::span<const LaneSums> sums, const Saturation* earlier, std::size_t first, Saturation& result) {
    for (std::size_t index = 0; index < sums.size(); ++index) {
        LaneSaturation& lane = result.lanes[first + index];
        lane.vehicles_per_green = mean_or_nan(sums[index].vehicles_per_green);
        lane.startup_lost_time_s = mean_or_nan(sums[index].startup_lost_time_s);
        const double headway_s = mean_or_nan(sums[index].saturation_headway_s);
        if (!std::isnan(headway_s)) {
            lane.flow_veh_h = 3600.0 / headway_s;
        } else if (earlier != nullptr) {
            lane.flow_veh_h = earlier->lanes[first + index].flow_veh_h;
            lane.startup_lost_time_s = earlier->lanes[first + index].startup_lost_time_s;
        }
    }
}

// Sets the lost time of a stage from its lanes without left turns.
void set_lost_time(int stage, const Scenario& saturated, std::size_t lanes, Saturation& result) {
    std::vector<double> startup_s;
    std::vector<double> startup_with_left_s;
    std::vector<double> end_gain_s;
    for (std::size_t index = 0; index < lanes; ++index) {
        const LaneSaturation& lane = result.lanes[at(stage) * lanes + index];
        if (std::isnan(lane.startup_lost_time_s)) continue;
        (lane.turns_left ? startup_with_left_s : startup_s).push_back(lane.startup_lost_time_s);
        if (lane.turns_left) continue;
        const double used_s = lane.vehicles_per_green * 3600.0 / lane.flow_veh_h;
        end_gain_s.push_back(used_s + lane.startup_lost_time_s - saturated.signal.group_green_s(stage));
    }
    StageLostTime& lost = result.lost[at(stage)];
    const std::vector<double>& known_s = startup_s.empty() ? startup_with_left_s : startup_s;
    lost.startup_s = known_s.empty() ? 0.0 : mean_of(known_s);
    const double change_s = saturated.signal.yellow_s + saturated.signal.all_red_s;
    lost.end_gain_s = end_gain_s.empty() ? std::min(kUsualEndGain_s, change_s) : mean_of(end_gain_s);
}

// Sets the flows of lanes with left turns, and of lanes on which no queue of five vehicles passed.
void set_flows_by_count(const Scenario& saturated, Saturation& result) {
    for (LaneSaturation& lane : result.lanes) {
        if (!lane.turns_left && lane.flow_veh_h > 0.0) continue;
        const double displayed_s = saturated.signal.group_green_s(lane.stage);
        const double green_s = std::max(result.lost[at(lane.stage)].effective_green_s(displayed_s), 1.0);
        lane.flow_veh_h = 3600.0 * lane.vehicles_per_green / green_s;
    }
}

// Returns the highest demand of the lanes with this stage and place, veh/h.
double highest_veh_h(const std::vector<LaneDemand>& demands, int stage, int index) {
    double highest = 0.0;
    for (const LaneDemand& one : demands) {
        if (one.stage == stage && one.index == index) highest = std::max(highest, one.flow_veh_h);
    }
    return highest;
}

bool is_first_leg(const Lane& lane) {
    const Side side = comes_from(lane);
    return side == Side::west || side == Side::south;
}

// Lets vehicles arrive on the legs in the east and north at the rate of the demand. The other legs stay saturated.
void limit_oncoming_traffic(const std::vector<LaneDemand>& demands, Model& model) {
    for (DemandPlan::Inlet& inlet : model.demand.inlets) {
        const Lane& lane = model.graph.lanes[at(inlet.lane)];
        if (is_first_leg(lane)) continue;
        const double flow_veh_h = highest_veh_h(demands, stage_of_lane(lane), index_of_lane(lane));
        inlet.headway_s = flow_veh_h > 0.0 ? 3600.0 / flow_veh_h : 0.0;
        if (flow_veh_h == 0.0) inlet.vehicles = 0;
    }
}

// Measures the vehicles per green of all lanes with left turns, and replaces those of the first run.
void measure_left_lanes(const Scenario& saturated, std::size_t population, const std::vector<LaneDemand>& demands,
                        const std::function<bool(double)>& keep_going, Saturation& result) {
    constexpr int kWarmUpCycles = 3;  // the queues at the start of the run dissolve
    constexpr std::int64_t kTicksPerReport = 1000;
    Model model = build_model(saturated, population);
    limit_oncoming_traffic(demands, model);
    const double cycle_s = saturated.signal.intersection_cycle_s();
    const double from_s = saturated.signal.first_green_s + kWarmUpCycles * cycle_s;
    const double to_s = from_s + kLeftTurnCycles * cycle_s;
    PassageCounter counter(model.graph, from_s, cycle_s, kLeftTurnCycles);
    Simulation simulation(model);
    while (simulation.time_s() < to_s) {
        const bool reports = simulation.state().tick % kTicksPerReport == 0;
        if (reports && keep_going && !keep_going(simulation.time_s() / to_s)) throw Interrupted();
        simulation.step();
    }
    counter.read(simulation);
    result.has_violations = result.has_violations || !simulation.state().records.violations.none();
    for (std::size_t number = 0; number < model.graph.lanes.size(); ++number) {
        const Lane& lane = model.graph.lanes[number];
        if (lane.signal_group < 0 || !is_first_leg(lane)) continue;
        LaneSaturation& measured = result.lanes[result.place(stage_of_lane(lane), index_of_lane(lane))];
        if (!measured.turns_left) continue;
        const std::vector<double>& passed = counter.in_cycles(number);
        measured.vehicles_per_green = mean_of(passed);
        if (measured.vehicles_per_green > 0.0)
            measured.capacity_variance_ratio = variance_of(passed) / measured.vehicles_per_green;
    }
}

bool turns_left(const std::vector<LaneDemand>& demands, int stage, int index) {
    return std::any_of(demands.begin(), demands.end(), [&](const LaneDemand& one) {
        return one.stage == stage && one.index == index && one.left_share > 0.0;
    });
}

void check_lanes(const Scenario& saturated, const Saturation& result) {
    for (const LaneSaturation& lane : result.lanes) {
        if (lane.flow_veh_h > 0.0) continue;
        throw InputError(fmt::format(
            "{}: no vehicle passes on lane {} (from the left) of the street {} in a saturated run with {:g} s of green; "
            "left-turning vehicles may find no gap. Add a lane for left turns, or set fewer of them (demand.left)",
            result.population, lane.index, kTimingStreets[lane.stage], saturated.signal.group_green_s(lane.stage)));
    }
}

}  // namespace

std::size_t Saturation::place(int stage, int index) const {
    return at(stage) * (lanes.size() / kTimingStages) + at(index);
}

Scenario saturated_scenario(const Scenario& scenario, const StageGreens& greens_s) {
    Scenario saturated = scenario;
    saturated.network.kind = "intersection";
    // No vehicle that is further from the stop line at the start of green passes it before red.
    IntersectionSettings& layout = saturated.network.intersection;
    const double reach_m = layout.speed_limit_mps * (std::max(greens_s[0], greens_s[1]) + saturated.signal.yellow_s);
    layout.approach_length_m = std::max(layout.approach_length_m, reach_m);
    saturated.duration_s = 0.0;  // until the end of the measured cycles
    saturated.signal.first_green_s = 1.0;
    saturated.signal.green_s = greens_s[0];
    saturated.signal.cross_green_s = greens_s[1];
    saturated.signal.offset_s = 0.0;
    saturated.demand.kind = "saturated";
    saturated.demand.start = "queued";
    saturated.demand.cross_inflow_1ps = 0.0;
    saturated.demand.approaches.clear();
    saturated.measure.warmup_cycles = 1;
    saturated.measure.cycles = kSaturationCycles;
    saturated.measure.zone_radius_m.clear();
    return saturated;
}

Saturation measure_saturation(const Scenario& scenario, std::size_t population, const SaturationInput& input,
                              const std::function<bool(double)>& keep_going) {
    constexpr double kFirstRunShare = 0.5;  // of the work, for the progress
    const Scenario saturated = saturated_scenario(scenario, input.greens_s);
    const Model model = build_model(saturated, population);
    const TimeWindow window = measured_window(saturated);
    PassageCounter counter(model.graph, window.from_s, saturated.signal.intersection_cycle_s(), kSaturationCycles);
    Observation observation;
    observation.look = [&](std::size_t, const Simulation& simulation) { counter.read(simulation); };
    const auto on_step = [&](const Simulation& simulation) {
        constexpr std::int64_t kTicksPerReport = 1000;
        if (!keep_going || simulation.state().tick % kTicksPerReport != 0) return true;
        return keep_going(kFirstRunShare * simulation.time_s() / window.to_s);
    };
    const IntersectionResult run = run_intersection(saturated, population, on_step, observation);
    if (!run.complete) throw Interrupted();

    Saturation result;
    result.population = run.population;
    result.has_violations = !run.violations.none();
    const std::size_t lanes = scenario.network.intersection.lanes.size();
    for (int stage = 0; stage < kTimingStages; ++stage) {
        for (std::size_t index = 0; index < lanes; ++index) {
            const int place = static_cast<int>(index);
            result.lanes.push_back({stage, place, turns_left(input.demands, stage, place)});
        }
    }
    std::vector<LaneSums> sums(result.lanes.size());
    for (const LaneDischarge& one : run.discharge.lanes) {
        const auto named = [&](const Lane& lane) { return lane.name == one.lane; };
        const auto lane = std::find_if(model.graph.lanes.begin(), model.graph.lanes.end(), named);
        LaneSums& sum = sums[result.place(stage_of_lane(*lane), index_of_lane(*lane))];
        const auto number = static_cast<std::size_t>(lane - model.graph.lanes.begin());
        sum.vehicles_per_green.push_back(mean_of(counter.in_cycles(number)));
        if (one.saturated_greens == 0) continue;
        sum.saturation_headway_s.push_back(one.saturation_headway_s);
        sum.startup_lost_time_s.push_back(one.startup_lost_time_s);
    }
    for (int stage = 0; stage < kTimingStages; ++stage) {
        set_headways(std::span(sums).subspan(at(stage) * lanes, lanes), input.earlier, at(stage) * lanes, result);
        set_lost_time(stage, saturated, lanes, result);
    }
    const auto is_left = [](const LaneSaturation& lane) { return lane.turns_left; };
    if (std::any_of(result.lanes.begin(), result.lanes.end(), is_left)) {
        const auto report = [&](double share) {
            return !keep_going || keep_going(kFirstRunShare + (1.0 - kFirstRunShare) * share);
        };
        measure_left_lanes(saturated, population, input.demands, report, result);
    }
    set_flows_by_count(saturated, result);
    check_lanes(saturated, result);
    return result;
}

}  // namespace stopline

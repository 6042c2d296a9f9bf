#include "runs/network/network_metrics.h"

#include <array>
#include <utility>

#include "base/nan.h"
#include "base/units.h"
#include "runs/driving/energy_metrics.h"
#include "runs/driving/safety_metrics.h"
#include "runs/hcm/hcm_metrics.h"
#include "runs/network/gap_metrics.h"
#include "runs/network/speed_advice_metrics.h"
#include "scenario/kinds/network_kind.h"

namespace stopline {

namespace {

constexpr const char* name_of(DelayCause cause) { return kDelayCauseNames[static_cast<std::size_t>(cause)]; }

// All delay causes, in the order of DelayCause.
constexpr std::array kCauses{
    MetricKey{name_of(DelayCause::signal), "delay by red and yellow signals"},
    MetricKey{name_of(DelayCause::yielding), "delay by vehicles with priority"},
    MetricKey{name_of(DelayCause::junction_blocking), "delay by vehicles that are stopped in a conflict area"},
    MetricKey{name_of(DelayCause::turn_blocking), "delay by a full exit lane, if the first vehicle of the queue turns"},
    MetricKey{name_of(DelayCause::spillback),
              "delay by a full exit lane, if the first vehicle of the queue goes straight on"},
    MetricKey{name_of(DelayCause::gridlock), "delay in a gridlock or behind one"},
    MetricKey{name_of(DelayCause::wrong_lane),
              "delay by vehicles that wait for a gap in the adjacent lane, because their route continues there",
              "the first vehicle of the queue waits for a gap to change lanes"},
    MetricKey{name_of(DelayCause::queue_discharge),
              "delay of vehicles that nothing blocks any more: the leader already moves, or the vehicle closes up to "
              "its queue"},
    MetricKey{name_of(DelayCause::refusal),
              "delay by cooperative clearing, which holds the first vehicle of the queue at its stop line"}};
static_assert(kCauses.size() + 1 == kDelayCauseNames.size());  // DelayCause::none has no metric
constexpr std::size_t kFirstCause = 1;
constexpr MetricFamily kDelayCauses{"CAUSE", nullptr, kCauses};
// The causes of blockages (is_blocking()).
constexpr std::size_t kFirstBlocking = static_cast<std::size_t>(DelayCause::junction_blocking);
constexpr MetricFamily kBlockingCauses{"CAUSE", nullptr, std::span(kCauses).subspan(kFirstBlocking - kFirstCause, 5)};

// Sides of entry and exit of vehicles that go straight through the network.
constexpr std::array kStraightThrough{std::pair{Side::west, Side::east}, std::pair{Side::south, Side::north},
                                      std::pair{Side::east, Side::west}, std::pair{Side::north, Side::south}};

std::vector<std::string> straight_through_names(const Scenario& scenario) {
    if (network_kind(scenario.network).has_trips) return {};
    std::vector<std::string> names;
    for (const auto& [from, to] : kStraightThrough) {
        names.push_back(
            fmt::format("{}_{}", kSideNames[static_cast<std::size_t>(from)], kSideNames[static_cast<std::size_t>(to)]));
    }
    return names;
}
constexpr MetricFamily kSidePairs{"SIDE_SIDE", straight_through_names};

// Returns the result of the pair of sides with the index run.key.
OriginDestinationResult straight_through(const MeasuredNetwork& run) {
    const auto& [from, to] = kStraightThrough[run.key];
    for (const OriginDestinationResult& pair : run.result.origin_destination) {
        if (pair.from == from && pair.to == to) return pair;
    }
    return {from, to, 0, kNan};
}

// Returns the share of one blocking cause in the delay of all causes, %.
double blocking_share_percent(const MeasuredNetwork& run) {
    const auto& delay_s = run.result.delays.delay_s;
    double total_s = 0.0;
    for (std::size_t k = kFirstCause; k < delay_s.size(); ++k) total_s += delay_s[k];
    return total_s > 0.0 ? 100.0 * delay_s[kFirstBlocking + run.key] / total_s : 0.0;
}

bool uses_clearing(const Scenario& scenario) { return scenario.rules.clearing == "cooperative"; }

std::string stability_text(const NetworkResult& result) {
    const double since_s = result.collapse_s.value_or(0.0);
    const std::string stability = kStabilityNames[static_cast<std::size_t>(result.stability)];
    switch (result.unstable_by) {
        case InstabilityCause::none:
            return stability;
        case InstabilityCause::throughput_drop:
            return stability + fmt::format(", throughput drops at {:.0f} s", since_s);
        case InstabilityCause::teleported:
            return stability + fmt::format(", 1 % teleported by {:.0f} s", since_s);
        case InstabilityCause::gridlock:
            return stability + fmt::format(", gridlock since {:.0f} s", since_s);
        case InstabilityCause::starvation:
            return stability + fmt::format(", a movement starves since {:.0f} s", since_s);
    }
    return stability;
}

MetricList<MeasuredNetwork> area_metrics() {
    return {
        {.column = "throughput_veh_h",
         .unit = "veh/h",
         .extent = "window",
         .meaning = "vehicles that leave the area; imported networks: trips that end",
         .value = [](const MeasuredNetwork& run) { return run.result.measured.throughput_veh_h(); },
         .summary_decimals = 2,
         .console = {.heading = "throughput", .decimals = 0, .note = "vehicles that leave the area"},
         .figure = {.sweep = {.change = "throughput gain over {} [%]"}}},
        {.column = "improvement_percent",
         .unit = "%",
         .extent = "window",
         .meaning = "gain in throughput over `measure.baseline`; empty without a baseline",
         .value =
             [](const MeasuredNetwork& run) {
                 return run.report == nullptr ? kNan : run.report->improvement_percent(run.result);
             },
         .summary_decimals = 2,
         .sweep_decimals = kLeftOut,
         .console = {.heading = "gain", .decimals = 1, .note = "in throughput, compared with the baseline"}},
        {.column = "travel_time_s",
         .unit = "s",
         .extent = "window",
         .meaning = "mean time in the area, over the vehicles that leave it within the window; queues upstream of the "
                    "area do not count. Imported networks: mean time from entering the network to the end of the trip",
         .value = [](const MeasuredNetwork& run) { return run.result.measured.travel_time_s; },
         .summary_decimals = 3,
         .console = {.heading = "travel time", .decimals = 1, .note = "mean of the vehicles that leave the area"},
         .figure = {.sweep = {.change = "travel time saved against {} [%]", .better = Better::lower}}},
        {.column = "travel_time_saved_percent",
         .unit = "%",
         .extent = "window",
         .meaning = "reduction of the travel time, compared with `measure.baseline`. Empty without a baseline. Also "
                    "empty if in either run the number of vehicles in the area, divided by the throughput, exceeds "
                    "`travel_time_s` by more than 50 %: then the travel times cover only the few vehicles that get "
                    "through",
         .value =
             [](const MeasuredNetwork& run) {
                 return run.report == nullptr ? kNan : run.report->time_saved_percent(run.result);
             },
         .summary_decimals = 2,
         .sweep_decimals = kLeftOut,
         .console = {.heading = "time saved", .decimals = 1, .note = "compared with the baseline"}},
        {.column = "density_percent",
         .unit = "%",
         .extent = "window",
         .meaning = "share of the lane length in the area that vehicles occupy; the length across an intersection "
                    "counts once for each lane that leads to it",
         .value = [](const MeasuredNetwork& run) { return 100.0 * run.result.measured.occupied; },
         .summary_decimals = 3,
         .console = {.heading = "density",
                     .decimals = 1,
                     .note = "share of its lane length that vehicles occupy",
                     .value =
                         [](const MeasuredNetwork& run) {
                             return run.has_window() ? 100.0 * run.result.measured.occupied : kNan;
                         }},
         // A lower density is not always better, because it can also mean less traffic.
         .figure = {.sweep = {.change = "density change against {} [%]", .better = Better::neither}}},
        {.column = "throughput_SIDE_SIDE_veh_h",
         .unit = "veh/h",
         .extent = "window",
         .meaning = "grids and streets: throughput straight through the network, from the first side to the second",
         .value =
             [](const MeasuredNetwork& run) {
                 return straight_through(run).exited * kSecondsPerHour / run.result.measured.window.length_s();
             },
         .summary_decimals = kLeftOut,
         .family = &kSidePairs},
        {.column = "travel_time_SIDE_SIDE_s",
         .unit = "s",
         .extent = "window",
         .meaning = "mean travel time of these vehicles",
         .value = [](const MeasuredNetwork& run) { return straight_through(run).travel_time_s; },
         .summary_decimals = kLeftOut,
         .family = &kSidePairs},
    };
}

MetricList<MeasuredNetwork> window_metrics() {
    return {
        {.column = "vehicles_in_area",
         .unit = "veh",
         .extent = "window",
         .meaning = "mean number of vehicles in the area",
         .value = [](const MeasuredNetwork& run) { return run.result.measured.vehicles; },
         .summary_decimals = 2},
        {.column = "vehicles_present",
         .unit = "veh",
         .extent = "window, network",
         .meaning = "mean number of vehicles in the network, sampled every second",
         .value = [](const MeasuredNetwork& run) { return run.result.vehicles_present; },
         .summary_decimals = 2,
         .console = {.heading = "vehicles",
                     .decimals = 0,
                     .note = "mean number in the whole network, queues upstream of the area included",
                     .value =
                         [](const MeasuredNetwork& run) {
                             return run.has_window() ? run.result.vehicles_present : kNan;
                         }}},
        {.column = "max_present",
         .unit = "veh",
         .extent = "run",
         .meaning = "largest number of vehicles in the network, sampled every second",
         .value = [](const MeasuredNetwork& run) { return run.result.max_present; }},
        {.column = "window_from_s",
         .unit = "s",
         .meaning = "start of the measured window. The window consists of the whole intervals (`measure.interval`) in "
                    "the last `measure.window` of the run. A run that is not longer than `measure.window` is measured "
                    "from `warm_up_s` on. Empty: the window contains no whole interval",
         .value =
             [](const MeasuredNetwork& run) { return run.has_window() ? run.result.measured.window.from_s : kNan; },
         .sweep_decimals = 1},
        {.column = "window_to_s",
         .unit = "s",
         .meaning = "end of the measured window",
         .value = [](const MeasuredNetwork& run) { return run.has_window() ? run.result.measured.window.to_s : kNan; },
         .sweep_decimals = 1},
        {.column = "warm_up_s",
         .unit = "s",
         .extent = "run",
         .meaning = "end of the warm-up, found from the number of vehicles in the area with the rule MSER-5. 0 if it "
                    "cannot be found because the run has fewer than 15 intervals (`measure.interval`)",
         .value = [](const MeasuredNetwork& run) { return run.result.warm_up_s; },
         .sweep_decimals = 1,
         .has_mean = false},
    };
}

MetricList<MeasuredNetwork> stability_metrics() {
    return {
        {.column = "stability",
         .extent = "run",
         .meaning = "`stable`: no gridlock and no teleported vehicle. `semi-stable`: all gridlocks dissolve, and less "
                    "than 1 % of the exited vehicles were teleported. `unstable`: for the reason in `unstable_by`",
         .value =
             [](const MeasuredNetwork& run) { return kStabilityNames[static_cast<std::size_t>(run.result.stability)]; },
         .console = {.heading = "stability",
                     .note = "of the whole run. semi-stable: gridlocks or teleported vehicles, but all gridlocks "
                             "dissolve, and less than 1 % of the vehicles that left were teleported",
                     .value = [](const MeasuredNetwork& run) { return stability_text(run.result); }}},
        {.column = "unstable_by",
         .extent = "run",
         .meaning = "first reason that holds. `throughput_drop`: gridlocks occur and throughput drops permanently. "
                    "`teleported`: 1 % or more of the exited vehicles were teleported. `gridlock`: a gridlock has "
                    "lasted for six signal cycles or more at the end. `starvation`: a movement starves "
                    "(`starvations`). Empty: the run is not unstable",
         .value =
             [](const MeasuredNetwork& run) {
                 return kInstabilityCauseNames[static_cast<std::size_t>(run.result.unstable_by)];
             }},
        {.column = "collapse_s",
         .unit = "s",
         .extent = "run",
         .meaning = "time from which the run is unstable. `throughput_drop`: start of the signal cycle from which on "
                    "throughput is lower by 10 % or more. `teleported`: end of the last signal cycle with less than "
                    "1 % teleported. `gridlock`: first observation of the gridlock. `starvation`: stop of the first "
                    "vehicle that starves. Empty: the run is not unstable",
         .value = [](const MeasuredNetwork& run) { return run.result.collapse_s.value_or(kNan); },
         .sweep_decimals = 1},
    };
}

MetricList<MeasuredNetwork> gridlock_metrics() {
    return {
        {.column = "delay_share_CAUSE_percent",
         .unit = "%",
         .value = blocking_share_percent,
         .summary_decimals = kLeftOut,
         .sweep_decimals = kLeftOut,
         .family = &kBlockingCauses,
         .console = {.table = ConsoleTable::congestion, .heading = "CAUSE", .decimals = 1}},
        {.column = "gridlocks",
         .extent = "run",
         .meaning = "number of gridlocks: cycles of vehicles that wait for each other. A cycle that shares a vehicle "
                    "with one seen within the last signal cycle is the same gridlock",
         .value = [](const MeasuredNetwork& run) { return run.result.delays.gridlocks.size(); },
         .console = {.table = ConsoleTable::congestion, .heading = "gridlocks", .begins_part = true}},
        {.column = "first_gridlock_s",
         .unit = "s",
         .extent = "run",
         .meaning = "first observation of the first gridlock",
         .value =
             [](const MeasuredNetwork& run) {
                 const std::vector<Gridlock>& gridlocks = run.result.delays.gridlocks;
                 return gridlocks.empty() ? kNan : gridlocks[0].from_s;
             },
         .sweep_decimals = 1},
        starvations_metric<MeasuredNetwork>(),
        {.column = "teleported",
         .unit = "veh",
         .extent = "run",
         .meaning = "vehicles removed by `rules.teleport_cycles`, including those that are not reinserted yet. "
                    "Imported networks: missed turns are included",
         .value = [](const MeasuredNetwork& run) { return run.result.delays.teleported; },
         .console = {.table = ConsoleTable::congestion, .heading = "teleported"}},
        {.column = "passed_blockers",
         .extent = "run",
         .meaning = "number of times that a vehicle passes a blocker in a conflict area, as "
                    "`rules.pass_blocker_greens` allows; each pair of a vehicle and a blocker counts once",
         .value = [](const MeasuredNetwork& run) { return run.result.delays.passed_blockers; },
         .console = {.table = ConsoleTable::congestion,
                     .heading = "passed\nblockers",
                     .note = "vehicles that passed one that blocked the intersection, by rules.pass_blocker_greens"}},
        {.column = "refused",
         .unit = "veh",
         .extent = "run",
         .meaning = "number of times that cooperative clearing (`rules.clearing`) begins to hold a vehicle at its stop "
                    "line",
         .value = [](const MeasuredNetwork& run) { return run.result.delays.refused; },
         .console = {.table = ConsoleTable::congestion,
                     .heading = "refused",
                     .note = "number of times that rules.clearing began to hold a vehicle at its stop line (delay: "
                             "delay_refusal_h in summary.csv)",
                     .asked_for = uses_clearing}},
        {.column = "refused_stop_h",
         .unit = "veh h",
         .extent = "run",
         .meaning = "time for which vehicles that cooperative clearing refuses are stopped at their stop line, without "
                    "the queues behind them",
         .value = [](const MeasuredNetwork& run) { return run.result.delays.refused_stop_s / kSecondsPerHour; },
         .summary_decimals = 3},
    };
}

MetricList<MeasuredNetwork> delay_metrics() {
    return {
        {.column = "delay_CAUSE_h",
         .unit = "veh h",
         .extent = "run",
         .value =
             [](const MeasuredNetwork& run) {
                 return run.result.delays.delay_s[kFirstCause + run.key] / kSecondsPerHour;
             },
         .summary_decimals = 3,
         .family = &kDelayCauses},
        {.column = "delay_upstream_h",
         .unit = "veh h",
         .extent = "run",
         .meaning = "part of the delay by all causes that occurs upstream of the measured area; 0 for imported "
                    "networks",
         .value = [](const MeasuredNetwork& run) { return run.result.delays.delay_upstream_s / kSecondsPerHour; },
         .summary_decimals = 3},
    };
}

MetricList<MeasuredNetwork> stop_metrics() {
    return {
        {.column = "longest_stop_s",
         .unit = "s",
         .extent = "run",
         .meaning = "longest single stop of any vehicle",
         .value = [](const MeasuredNetwork& run) { return run.result.delays.longest_stop_s; },
         .sweep_decimals = 1},
        {.column = "stops_per_vehicle",
         .extent = "run",
         .meaning = "number of stops in the whole network, counted once a second, per vehicle that entered",
         .value =
             [](const MeasuredNetwork& run) {
                 return run.result.entered == 0
                            ? kNan
                            : static_cast<double>(run.result.delays.stops) / static_cast<double>(run.result.entered);
             },
         .summary_decimals = 2,
         .sweep_decimals = 2},
        junction_time_metric<MeasuredNetwork>(1),
    };
}

MetricList<MeasuredNetwork> trip_metrics() {
    return {
        {.column = "entered",
         .unit = "veh",
         .extent = "run",
         .meaning = "vehicles that entered the network",
         .value = [](const MeasuredNetwork& run) { return run.result.entered; },
         .sweep_decimals = kLeftOut,
         .console = {.table = ConsoleTable::trips, .heading = "entered"}},
        {.column = "exited",
         .unit = "veh",
         .extent = "run",
         .meaning = "vehicles that left the network",
         .value = [](const MeasuredNetwork& run) { return run.result.exited; },
         .sweep_decimals = kLeftOut,
         .console = {.table = ConsoleTable::trips, .heading = "arrived"}},
        {.column = "en_route",
         .unit = "veh",
         .value = [](const MeasuredNetwork& run) { return run.result.entered - run.result.exited; },
         .summary_decimals = kLeftOut,
         .sweep_decimals = kLeftOut,
         .console = {.table = ConsoleTable::trips, .heading = "en route"}},
    };
}

MetricList<MeasuredNetwork> backlog_metrics() {
    return {
        {.column = "missed_turns",
         .unit = "veh",
         .extent = "run",
         .meaning = "imported networks only: vehicles that reached the stop line in a wrong lane and were teleported",
         .value = [](const MeasuredNetwork& run) { return run.result.missed_turns; },
         .sweep_decimals = kLeftOut,
         .only_for = &NetworkKind::has_trips,
         .console = {.table = ConsoleTable::trips,
                     .heading = "missed turns",
                     .note = "vehicles that reached the stop line in a wrong lane and were teleported"}},
        {.column = "backlog",
         .unit = "veh",
         .extent = "end of the run",
         .meaning = "vehicles that should have entered by then but found no room; 0 for saturated inlets and for "
                    "queues",
         .value = [](const MeasuredNetwork& run) { return run.result.backlog; },
         .sweep_after = "delay_upstream_h",
         .console = {.table = ConsoleTable::trips,
                     .heading = "backlog",
                     .note = "vehicles that found no room to enter before the run ended"}},
    };
}

Metric<MeasuredNetwork> breakdown_metric() {
    return {.column = "breakdown",
            .extent = "run",
            .meaning =
                "1: the run is unstable, or its mean departure delay exceeds the nominal signal cycle; 0: neither. "
                "The mean over seeds estimates the probability of a breakdown",
            .value =
                [](const MeasuredNetwork& run) {
                    const bool waits_long = run.result.departure.mean_s() > run.scenario.nominal_cycle().cycle_s;
                    return waits_long || run.result.stability == Stability::unstable ? 1 : 0;
                },
            .asked_for = asks_for_departure_delay};
}

}  // namespace

const MetricList<MeasuredNetwork>& network_metrics() {
    static const MetricList<MeasuredNetwork> kMetrics = joined_lists<MeasuredNetwork>(
        {area_metrics(), window_metrics(), stability_metrics(), gridlock_metrics(), delay_metrics(), gap_metrics(),
         speed_advice_metrics(), street_metrics(), stop_metrics(), trip_metrics(),
         count_metrics<MeasuredNetwork>(
             {"overlaps", "conflicts", "red_entries", "forced_red_entries", "lost_vehicles"}),
         backlog_metrics(), departure_metrics<MeasuredNetwork>(), MetricList<MeasuredNetwork>{breakdown_metric()},
         energy_metrics<MeasuredNetwork>(), safety_metrics<MeasuredNetwork>(), hcm_metrics<MeasuredNetwork>()});
    return kMetrics;
}

std::vector<MeasuredNetwork> measured_runs(const NetworkReport& report) {
    std::vector<MeasuredNetwork> runs;
    for (const NetworkResult& result : report.populations) runs.push_back({report.scenario, result, &report});
    return runs;
}

}  // namespace stopline

#include "runs/network/gap_metrics.h"

#include "base/units.h"
#include "scenario/fleets.h"

namespace stopline {

namespace {

// Returns true if some drivers ask for gaps by V2V.
bool opens_gaps_cooperatively(const Scenario& scenario) {
    return any_driver(scenario, [](const DriverSettings& driver) {
        return driver.lane_change.gap_opening_value() == GapOpening::cooperative;
    });
}

}  // namespace

MetricList<MeasuredNetwork> gap_metrics() {
    MetricList<MeasuredNetwork> metrics{
        {.column = "gaps_requested",
         .unit = "veh",
         .extent = "run",
         .meaning = "vehicles that ask for a gap (`driver.lane_change.gap_opening`), once for each lane change",
         .value = [](const MeasuredNetwork& run) { return run.result.gap_counts.requested; }},
        {.column = "gaps_agreed",
         .unit = "",
         .extent = "run",
         .meaning = "number of agreements to open a gap",
         .value = [](const MeasuredNetwork& run) { return run.result.gap_counts.agreed; }},
        {.column = "gaps_opened",
         .unit = "",
         .extent = "run",
         .meaning = "number of gaps that have reached their length",
         .value = [](const MeasuredNetwork& run) { return run.result.gap_counts.opened; }},
        {.column = "gaps_used",
         .unit = "",
         .extent = "run",
         .meaning = "number of lane changes to the place ahead of the vehicle that has agreed",
         .value = [](const MeasuredNetwork& run) { return run.result.gap_counts.of(GapEnding::used); }},
        {.column = "gaps_expired",
         .unit = "",
         .extent = "run",
         .meaning = "number of agreements that have reached their time limit",
         .value = [](const MeasuredNetwork& run) { return run.result.gap_counts.of(GapEnding::expired); }},
        {.column = "gaps_taken",
         .unit = "",
         .extent = "run",
         .meaning = "number of agreements whose gap a third vehicle takes",
         .value = [](const MeasuredNetwork& run) { return run.result.gap_counts.of(GapEnding::taken); }},
        {.column = "gaps_left",
         .unit = "",
         .extent = "run",
         .meaning = "number of agreements whose opener leaves its lane",
         .value = [](const MeasuredNetwork& run) { return run.result.gap_counts.of(GapEnding::left); }},
        {.column = "gaps_missed",
         .unit = "",
         .extent = "run",
         .meaning = "number of agreements whose requester is no longer beside its gap",
         .value = [](const MeasuredNetwork& run) { return run.result.gap_counts.of(GapEnding::missed); }},
        {.column = "gaps_stopped",
         .unit = "",
         .extent = "run",
         .meaning =
             "number of agreements that end because the opener must stop at the line or the requester has to wait",
         .value = [](const MeasuredNetwork& run) { return run.result.gap_counts.of(GapEnding::stopped); }},
        {.column = "gaps_lost",
         .unit = "",
         .extent = "run",
         .meaning =
             "number of agreements that end because one vehicle hears nothing from the other for 1 s (`driver.v2v`)",
         .value = [](const MeasuredNetwork& run) { return run.result.gap_counts.of(GapEnding::lost); }},
        {.column = "gaps_not_needed",
         .unit = "",
         .extent = "run",
         .meaning =
             "number of agreements whose requester leaves its lane otherwise, or needs the lane change no longer",
         .value = [](const MeasuredNetwork& run) { return run.result.gap_counts.of(GapEnding::not_needed); }},
        {.column = "gap_delay_h",
         .unit = "veh h",
         .extent = "run",
         .meaning =
             "delay of the vehicles whose gap has reached its length, estimated from the growth of the gap, without the "
             "vehicles behind them",
         .value = [](const MeasuredNetwork& run) { return run.result.gap_counts.given_s / kSecondsPerHour; },
         .summary_decimals = 4},
    };
    for (Metric<MeasuredNetwork>& metric : metrics) metric.asked_for = opens_gaps_cooperatively;
    return metrics;
}

}  // namespace stopline

// Metrics of the report by the Highway Capacity Manual. Only scenarios with `measure.hcm: on` have them.
#pragma once

#include "base/nan.h"
#include "runs/hcm/hcm_sampler.h"
#include "runs/hcm/hcm_tables.h"
#include "runs/metrics/metric.h"

namespace stopline {

// `Run` has the member result.hcm.
template <class Run>
MetricList<Run> hcm_metrics() {
    MetricList<Run> metrics{
        {.column = "hcm_control_delay_s",
         .unit = "s",
         .extent = "window",
         .meaning = "mean control delay of the vehicles of the intersection, by the Highway Capacity Manual; with "
                    "several intersections, of the worst one. This column and the next two are written only with "
                    "`measure.hcm: on`",
         .value =
             [](const Run& run) {
                 const HcmRow* const row = worst_intersection(run.result.hcm);
                 return row == nullptr ? kNan : row->control_delay_s;
             },
         .summary_decimals = 2},
        {.column = "hcm_degree_of_saturation",
         .extent = "window",
         .meaning = "highest degree of saturation of a lane: volume over capacity",
         .value = [](const Run& run) { return highest_saturation(run.result.hcm); },
         .summary_decimals = 4},
        {.column = "hcm_los",
         .extent = "window",
         .meaning = "level of service of the approach with the longest control delay, A to F",
         .value =
             [](const Run& run) {
                 const HcmRow* const row = worst_approach(run.result.hcm);
                 return row == nullptr ? std::string() : hcm_level_text(row->level);
             },
         .has_mean = false}};
    for (Metric<Run>& metric : metrics) metric.asked_for = asks_for_hcm;
    return metrics;
}

}  // namespace stopline

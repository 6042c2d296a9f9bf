// The metrics of a single light.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runs/metrics/shared_metrics.h"
#include "runs/single_light/single_light.h"

namespace stopline {

// The finished run of one population.
struct MeasuredLight {
    const Scenario& scenario;
    const PopulationSummary& summary;
    const RunResult& run;
    std::size_t key = 0;

    const std::string& population() const { return summary.name; }
    RunCounts counts() const {
        return {run.vehicles_entered, run.vehicles_exited, run.violations, run.updates, run.state_hash, run.v2v,
                run.departure,        run.backlog,         run.driving};
    }
};

const MetricList<MeasuredLight>& single_light_metrics();

// The finished run of one population, up to the end of one green time of `measure.green`.
struct MeasuredGreen {
    const SingleLightReport* report = nullptr;  // null in sweeps, which run one population at a time
    const Scenario& scenario;
    const PopulationSummary& summary;
    std::size_t green = 0;  // index in measure.green
    std::size_t key = 0;

    const std::string& population() const { return summary.name; }
    double green_s() const { return scenario.measure.green_s[green]; }
    // Returns the summary of the baseline; null without a baseline.
    const PopulationSummary* baseline() const {
        return report != nullptr && report->baseline ? &report->populations[*report->baseline] : nullptr;
    }
};

// The metrics of each green time. Each metric is a column of improvement.csv and a block of columns of the table on the
// console. If sweeps have the metric, it has one column for each green time there: `passed_veh` becomes `passed_1_veh`,
// `passed_2_veh`, ... In texts for figures, K stands for the number of the green time. In meanings, kThisGreen stands
// for the green time. In console headings, kTheBaseline stands for the name of the baseline. Without a baseline, the
// console omits blocks with kTheBaseline.
const MetricList<MeasuredGreen>& green_metrics();
inline constexpr std::string_view kThisGreen = "GREEN";
inline constexpr std::string_view kTheBaseline = "BASELINE";

// Returns the metrics of sweeps with a column for each green time. They refer to texts that exist until the end of the
// program.
MetricList<MeasuredLight> numbered_green_metrics(const MetricList<MeasuredGreen>& greens);

// Return the runs of all populations of a report, and each of them up to each green time.
std::vector<MeasuredLight> measured_runs(const SingleLightReport& report);
std::vector<MeasuredGreen> measured_greens(const SingleLightReport& report);

}  // namespace stopline

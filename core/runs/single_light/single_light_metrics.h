// The metrics of a single light.
#pragma once

#include <string>
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
        return {run.vehicles_entered, run.vehicles_exited, run.violations, run.updates, run.state_hash};
    }
};

const MetricList<MeasuredLight>& single_light_metrics();

// Returns the runs of all populations of a report.
std::vector<MeasuredLight> measured_runs(const SingleLightReport& report);

}  // namespace stopline

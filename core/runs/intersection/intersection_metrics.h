// The metrics of a single intersection.
#pragma once

#include <string>
#include <vector>

#include "runs/intersection/intersection.h"
#include "runs/metrics/shared_metrics.h"

namespace stopline {

// The finished run of one population. `report` compares it with the baseline; null in sweeps.
struct MeasuredIntersection {
    const Scenario& scenario;
    const IntersectionResult& result;
    const IntersectionReport* report = nullptr;
    std::size_t key = 0;

    const std::string& population() const { return result.population; }
    RunCounts counts() const {
        return {result.entered, result.exited,    result.violations, result.updates, result.state_hash,
                result.v2v,     result.departure, result.backlog,    result.driving};
    }
    std::size_t starvations() const { return result.starvations.size(); }
    double longest_in_junction_s() const { return result.longest_in_junction_s; }
};

const MetricList<MeasuredIntersection>& intersection_metrics();

// Returns the runs of all populations of a report.
std::vector<MeasuredIntersection> measured_runs(const IntersectionReport& report);

}  // namespace stopline

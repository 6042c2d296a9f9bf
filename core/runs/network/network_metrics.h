// The metrics of networks of several intersections: grids, streets and imported networks.
#pragma once

#include <string>
#include <vector>

#include "runs/metrics/shared_metrics.h"
#include "runs/network/network.h"

namespace stopline {

// The finished run of one population. `report` compares it with the baseline; null in sweeps.
struct MeasuredNetwork {
    const Scenario& scenario;
    const NetworkResult& result;
    const NetworkReport* report = nullptr;
    std::size_t key = 0;

    const std::string& population() const { return result.population; }
    RunCounts counts() const {
        return {result.entered, result.exited,    result.violations, result.updates, result.state_hash,
                result.v2v,     result.departure, result.backlog,    result.driving};
    }
    std::size_t starvations() const { return result.delays.starvations.size(); }
    double longest_in_junction_s() const { return result.longest_in_junction_s; }
    bool has_window() const { return result.measured.window.length_s() > 0.0; }
};

const MetricList<MeasuredNetwork>& network_metrics();
// Returns the metrics that only streets have (street_metrics.cpp). They are part of network_metrics().
MetricList<MeasuredNetwork> street_metrics();

// Returns the runs of all populations of a report.
std::vector<MeasuredNetwork> measured_runs(const NetworkReport& report);

}  // namespace stopline

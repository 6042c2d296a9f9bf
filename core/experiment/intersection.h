// All populations of an intersection, side by side in threads, and what is reported of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiment/intersection_run.h"

namespace stopline {

struct IntersectionReport {
    Scenario scenario;
    std::vector<IntersectionFigures> populations;  // in the order of the scenario

    // Of throughput over the baseline, in percent; NaN without one.
    double improvement_percent(const IntersectionFigures& figures) const;
    bool no_violations() const;
};

// The same bits for any number of threads. `on_progress` gets the share done and returns false to stop: throws Interrupted.
IntersectionReport run_intersections(const Scenario& scenario, int threads,
                                     const std::function<bool(double)>& on_progress = {});

std::string intersection_csv(const IntersectionReport& report);  // a row a population
std::string headways_csv(const IntersectionReport& report);      // by position in the queue

}  // namespace stopline

// When vehicles passed the detectors of a scenario, and how far two runs of it are apart there (Section V.B, step I).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "experiment/run_metrics.h"
#include "sim/simulation.h"

namespace stopline {

using DetectorTimes = std::vector<std::vector<double>>;  // [detector of the model][k-th vehicle], s

// "c1r1_south_in_0 stop_line": its lane and what it is.
std::string detector_name(const Model& model, std::size_t detector);

struct DetectorRun {
    DetectorTimes times;
    Violations violations;
    std::int64_t updates = 0;
    bool complete = false;
};

// Runs the model until all vehicles have left, or to the end of the scenario. Stops once `keep_going` says no.
DetectorRun run_detectors(const Scenario& scenario, const Model& model, const std::function<bool()>& keep_going = {});

// The same as what a sweep stores: a metric a detector, its times with spaces between them. Empty: stopped.
std::vector<RunMetric> detector_metrics(const Scenario& scenario, std::size_t population,
                                        const std::function<bool()>& keep_going);
// Read back from result_text.
DetectorTimes times_of(const std::string& result, const Model& model);

// The k-th passage of one run and the k-th of the other.
struct PassagePair {
    int detector;
    int k;  // from 0
    double reference_s;
    double other_s;
    double difference_s() const { return other_s - reference_s; }
};

struct PairedTimes {
    std::vector<PassagePair> pairs;
    std::map<int, int>
        unpaired;  // by detector: passages of one run that the other does not have; only where there are any
    int unpaired_in_all() const;
};
PairedTimes pair_up(const DetectorTimes& reference, const DetectorTimes& other);

// What many pairs come to.
struct Agreement {
    std::size_t pairs = 0;
    std::size_t unpaired = 0;
    double within_share = 0.0;  // of pairs and unpaired, those that differ by no more than the limit
    double median_s = 0.0;      // of the absolute differences
    double p95_s = 0.0;
    double largest_s = 0.0;
    std::size_t other_green = 0;  // pairs that differ by half a cycle or more: not in the same green
};
struct SizedPairs {
    const PairedTimes* times;
    double cycle_s;
};
Agreement agreement(std::span<const SizedPairs> permutations, double limit_s);

}  // namespace stopline

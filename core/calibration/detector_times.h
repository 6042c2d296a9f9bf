// Times at which vehicles pass the detectors of a scenario, and the differences between these times in two runs of the
// scenario (Section V.B of the paper, step I).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "runs/run_metrics.h"
#include "sim/step/simulation.h"

namespace stopline {

using DetectorTimes = std::vector<std::vector<double>>;  // [detector][passage], s

// Returns the lane and the kind of the detector, such as "c1r1_south_in_0 stop_line". An induction loop has the name
// that the user gave it.
std::string detector_name(const Model& model, std::size_t detector);

struct DetectorRun {
    DetectorTimes times;
    Violations violations;
    std::int64_t updates = 0;  // number of vehicle updates (one vehicle in one step)
    bool complete = false;     // false: keep_going stopped the run
};

// Runs the model until all vehicles have exited or the scenario ends. Stops before that if `keep_going` returns false.
DetectorRun run_detectors(const Scenario& scenario, const Model& model, const std::function<bool()>& keep_going = {});

// Runs the scenario and returns the results that a sweep stores. Each detector with passages has one result: the text
// of its passage times, separated by spaces. The other results are the numbers of overlaps (conflicts included),
// entries on red, lost vehicles, and vehicle updates. Returns an empty list if `keep_going` stopped the run.
std::vector<RunMetric> detector_metrics(const Scenario& scenario, std::size_t population,
                                        const std::function<bool()>& keep_going);
// Reads the passage times from a stored result of detector_metrics().
DetectorTimes parse_detector_times(const std::string& result, const Model& model);

// The k-th passage of a detector in two runs.
struct PassagePair {
    int detector;
    int k;  // number of the passage, from 0
    double reference_s;
    double other_s;
    double difference_s() const { return other_s - reference_s; }
};

struct PairedTimes {
    std::vector<PassagePair> pairs;
    // [detector] number of passages that only one of the two runs has. Detectors without such passages have no entry.
    std::map<int, int> unpaired;
    int unpaired_count() const;  // sum over all detectors
};
PairedTimes pair_up(const DetectorTimes& reference, const DetectorTimes& other);

// Statistics of many pairs.
struct Agreement {
    std::size_t pairs = 0;
    std::size_t unpaired = 0;
    double within_share = 0.0;    // pairs within the limit, as a share of all pairs and unpaired passages
    double median_s = 0.0;        // median of the absolute differences
    double p95_s = 0.0;           // 95th percentile of the absolute differences
    double largest_s = 0.0;       // largest absolute difference
    std::size_t other_green = 0;  // pairs that differ by half a cycle or more: their vehicles used different greens
};
// The pairs of passages in one permutation, and its cycle time.
struct PermutationPairs {
    const PairedTimes* times;
    double cycle_s;
};
Agreement agreement(std::span<const PermutationPairs> permutations, double limit_s);

}  // namespace stopline

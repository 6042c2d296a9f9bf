// Step I of the calibration (Section V.B of the paper). It compares the times at which vehicles pass detectors in full
// dynamics and in the mesoscale mode, for every permutation (combination of axis values) of a sweep and any set of
// mesoscale parameters. The k-th passages of a detector in both modes form a pair.
//
// The criterion is that the two times of each pair differ by at most one second. A user can review a larger difference
// and mark it as accepted (scenario/files/load_accepted.h); the pair is then valid. Every third permutation is held out
// of the fit.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "calibration/detector_times.h"
#include "calibration/meso_fit.h"
#include "scenario/files/load_accepted.h"
#include "sweeps/run_store.h"
#include "sweeps/sweep.h"

namespace stopline {

inline constexpr double kTimingLimit_s = 1.0;

// The data of one run of the sweep, that is, one combination of axis values, population and seed.
struct CalibrationCase {
    std::string permutation;  // "green = 15 s, offset = 0 s, population = CDG"
    double cycle_s = 0.0;
    FitCase fit;
};

// Builds one case for each run of the sweep. The store must hold the results of detector_metrics() for all runs in full
// dynamics. `settings` are the mesoscale parameters of every case.
std::vector<CalibrationCase> calibration_cases(const Sweep& sweep, const RunStore& full, const MesoSettings& settings);

// Results of one set of parameters in all permutations.
struct TimingResult {
    std::string name;
    MesoSettings settings;
    std::vector<PairedTimes> pairs;  // [case] pairs of passages
    Violations violations;           // sum over all runs
    std::int64_t updates = 0;        // number of vehicle updates (one vehicle in one step)
};
// Runs every case in the mesoscale mode and pairs its passages with those of full dynamics.
TimingResult evaluate_timing(const std::string& name, const std::vector<CalibrationCase>& cases,
                             const MesoSettings& settings, int threads);

// The cases used for the fit, the cases held out of it, or both.
enum class CaseSubset { fitted, held_out, all };
Agreement timing_agreement(const TimingResult& result, const std::vector<CalibrationCase>& cases, CaseSubset subset);

// One detector in one permutation with a difference: at least one pair of its passages differs by more than the limit,
// or at least one passage in one mode lacks a counterpart in the other mode.
struct TimingMiss {
    std::size_t permutation;  // index of the case
    int detector;
    int pairs_beyond_limit;
    int pairs_compared;
    int unpaired;          // number of passages without counterpart
    double largest_s;      // largest difference of a pair; positive if the vehicle passes later in the mesoscale mode
    int first_passage;     // number (from 1) of the first passage beyond the limit
    std::string cause;     // cause of the difference, as text
    std::string accepted;  // reason why the user accepts the difference; empty: not accepted
};

// Checks that the permutation and the detector of each entry exist. Throws InputError if not.
void check_accepted(const AcceptedFile& accepted, const Sweep& sweep);

std::vector<TimingMiss> timing_misses(const TimingResult& result, const std::vector<CalibrationCase>& cases,
                                      const AcceptedFile& accepted);

// Returns the share of valid passages. Each pair and each unpaired passage counts as one. A pair is valid if its times
// differ by at most the limit. Other pairs and unpaired passages are valid if the user accepted the differences at the
// detector in this permutation.
double valid_share(const TimingResult& result, const std::vector<CalibrationCase>& cases,
                   const std::vector<TimingMiss>& misses, CaseSubset subset);

// Return result tables as CSV.
std::string differences_csv(const TimingResult& result, const std::vector<CalibrationCase>& cases);
std::string misses_csv(const std::vector<TimingMiss>& misses, const std::vector<CalibrationCase>& cases);
std::string permutations_csv(const std::vector<TimingResult>& results, const std::vector<CalibrationCase>& cases);
std::string history_csv(const MesoFit& fit);

}  // namespace stopline

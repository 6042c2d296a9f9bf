// Step I of the calibration (Section V.B): how near the mesoscale mode's passages are to those of full dynamics, for all
// permutations of a sweep and any set of parameters.
//
// Objective criterion: no pair of passages differs by more than a second. Differences that someone has looked at and accepts
// (load_accepted.h) count as valid and are listed. Every third permutation is held out of the fit.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiment/detector_times.h"
#include "experiment/meso_fit.h"
#include "experiment/run_store.h"
#include "experiment/sweep.h"
#include "scenario/load_accepted.h"

namespace stopline {

inline constexpr double kTimingLimit_s = 1.0;

// A permutation: values of all axes and the population, one seed.
struct CalibrationCase {
    std::string permutation;  // "green = 15 s, offset = 0 s, population = CDG"
    double cycle_s = 0.0;
    FitCase fit;
};

// From a store that has all points of the sweep, as detector_metrics gives them. Mesoscale parameters are those of `settings`.
std::vector<CalibrationCase> calibration_cases(const Sweep& sweep, const RunStore& full, const MesoSettings& settings);

// One set of parameters on all permutations.
struct TimingResult {
    std::string name;
    MesoSettings settings;
    std::vector<PairedTimes> pairs;  // [case]
    Violations violations;           // of all runs
    std::int64_t updates = 0;
};
TimingResult judge_timing(const std::string& name, const std::vector<CalibrationCase>& cases,
                          const MesoSettings& settings, int threads);

enum class Chosen { fitted, held_out, all };
Agreement agreement_of(const TimingResult& result, const std::vector<CalibrationCase>& cases, Chosen chosen);

// A detector of a permutation where pairs differ by more than the limit.
struct TimingMiss {
    std::size_t permutation;
    int detector;
    int pairs;             // that differ by more
    int of;                // pairs there
    int unpaired;          // passages without a partner
    double largest_s;      // difference, signed, where it is largest
    int first;             // number of the first such vehicle, from 1
    std::string cause;     // see cause_of
    std::string accepted;  // the reason given; "": not accepted
};
std::vector<TimingMiss> timing_misses(const TimingResult& result, const std::vector<CalibrationCase>& cases,
                                      const AcceptedFile& accepted);

// Share of the pairs that are valid, with those that were accepted.
double valid_share(const TimingResult& result, const std::vector<CalibrationCase>& cases,
                   const std::vector<TimingMiss>& misses, Chosen chosen);

// Tables.
std::string differences_csv(const TimingResult& result, const std::vector<CalibrationCase>& cases);
std::string misses_csv(const std::vector<TimingMiss>& misses, const std::vector<CalibrationCase>& cases);
std::string permutations_csv(const std::vector<TimingResult>& results, const std::vector<CalibrationCase>& cases);
std::string history_csv(const MesoFit& fit);

}  // namespace stopline

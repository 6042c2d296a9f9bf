// Fits the parameters of the mesoscale mode to detector passages of full dynamics (Section V.B of the paper, step I).
// The k-th passages of a detector in both modes form a pair. The loss of a run is a mean over its pairs and its
// unpaired passages (fit_loss), or 1 if vehicles overlap or collide in a conflict area. The loss of a set of parameters
// is the mean over all runs. A single pair adds at most 1 to the sum of its run, however large its difference is.
//
// A permutation is a combination of axis values of a sweep. First, the time-gap model and the constant-distance model
// are fitted separately, each to the permutations in which all vehicles use this model. Each of these searches is
// repeated from several starting points. Then all parameters are fitted together to all permutations. The search is
// deterministic. After an interruption, the search therefore starts again with the same evaluations, and stored losses
// replace the evaluations that were finished before.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calibration/detector_times.h"
#include "sim/state/model.h"

namespace stopline {

// One parameter of the mesoscale mode. All vehicles share start delay and leader acceleration, which are fitted
// together with the parameters of the time-gap model.
struct FitParameter {
    const char* name = "";  // name in the parameter file, such as constant_time.reaction
    const char* unit = "";
    bool constant_distance = false;  // true: fitted with the constant-distance model; false: with the time-gap model
    double low = 0.0;                // bounds of the search, SI units; equal bounds: the parameter is not fitted
    double high = 0.0;
    double& (*value)(MesoSettings&) = nullptr;
    // Returns false if other settings make the parameter irrelevant. Null: the parameter is always used.
    bool (*is_used)(const MesoSettings&) = nullptr;

    bool is_free(const MesoSettings& settings) const { return low < high && (is_used == nullptr || is_used(settings)); }
};
const std::vector<FitParameter>& fit_parameters();

// One permutation: its model in the mesoscale mode, and its passages in full dynamics.
struct FitCase {
    Scenario scenario;
    Model model;
    DetectorTimes reference;
    bool held_out = false;
};

// Runs the case with the given parameters and returns its passages.
DetectorRun run_case(const FitCase& fit_case, const MesoSettings& settings);

// Returns the mean over all pairs of d^2 / (d^2 + limit^2), where d is the difference. An unpaired passage counts as 1.
double fit_loss(const PairedTimes& pairs, double limit_s);

struct FitEvaluation {
    std::string stage;           // name of the search: "constant_time 2" (second starting point), or "all"
    std::vector<double> values;  // values of all parameters, in the order of fit_parameters()
    double loss = 0.0;
};

struct FitOptions {
    int threads = 1;
    int starts = 3;
    int evaluations_per_start = 250;  // limit for each search that fits one model
    int joint_evaluations = 800;      // limit for the search that fits all parameters
    double limit_s = 1.0;
    // Returns the loss of evaluation `index` that an earlier, interrupted fit stored. Returns nothing if no loss is
    // stored, or if that evaluation had other parameter values.
    std::function<std::optional<double>(std::size_t index, const std::vector<double>& values)> stored_loss;
    std::function<void(std::size_t index, const FitEvaluation&)> on_evaluation;
    std::function<bool(double)> on_progress;  // gets the finished share; false: fit_meso throws Interrupted
};

struct MesoFit {
    MesoSettings settings;
    std::vector<FitEvaluation> history;
};

// Fits the parameters to the cases that are not held out. `start` holds the values at which the first search starts,
// and the values of all parameters that are not fitted.
MesoFit fit_meso(const std::vector<FitCase>& cases, const MesoSettings& start, const FitOptions& options);

}  // namespace stopline

// Fits the parameters of the mesoscale mode to passages of full dynamics (Section V.B, step I): a least-squares search of each
// pair of passages, the k-th at a detector in either mode, whose weight vanishes where the difference is far beyond a second.
//
// Models of the Krauss family are fitted to the permutations that have only their vehicles, from several starts each; then all
// together to all permutations. The search is a function of the numbers it is given alone, so that one that was killed, fed with
// what it had found by then, goes the same way.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiment/detector_times.h"
#include "sim/model.h"

namespace stopline {

// start_delay and the leaders' acceleration, which all vehicles share and which are fitted with the models with a time gap;
// then a, v_p, b, tau, sigma of either model, s_0, s_t and d, and what was added to the models.
struct FitParameter {
    const char* name = "";  // path within MesoSettings, as in a file
    const char* unit = "";
    bool constant_distance = false;  // whose it is
    double low = 0.0;                // bounds of the search, SI units; equal where others decide it
    double high = 0.0;
    double& (*in)(MesoSettings&) = nullptr;
    bool (*counts)(const MesoSettings&) = nullptr;  // whether it matters beside the others; not given: it does

    bool is_free(const MesoSettings& settings) const { return low < high && (counts == nullptr || counts(settings)); }
};
const std::vector<FitParameter>& fit_parameters();

// A permutation: a model of the mesoscale mode, and what full dynamics did.
struct FitCase {
    Scenario scenario;
    Model model;
    DetectorTimes reference;
    bool held_out = false;
};

// The passages of a case with other parameters.
DetectorRun run_case(const FitCase& fit_case, const MesoSettings& settings);

// Mean over all pairs of d^2 / (d^2 + limit^2), d their difference; 1 for passages without a partner.
double fit_loss(const PairedTimes& pairs, double limit_s);

struct FitEvaluation {
    std::string stage;           // "constant_time 2", "all"
    std::vector<double> values;  // of fit_parameters()
    double loss = 0.0;
};

struct FitOptions {
    int threads = 1;
    int starts = 3;
    int evaluations_apart = 250;  // a start, of one model
    int evaluations_together = 800;
    double limit_s = 1.0;
    // What the `index`-th evaluation gave in an earlier session, if it was made with these values.
    std::function<std::optional<double>(std::size_t index, const std::vector<double>& values)> known;
    std::function<void(std::size_t index, const FitEvaluation&)> on_evaluation;
    std::function<bool(double)> on_progress;  // share done; false: throws Interrupted
};

struct MesoFit {
    MesoSettings settings;
    std::vector<FitEvaluation> history;
};

// Uses the cases that are not held out. `start` is the first of the starts, and has the values of all that is not fitted.
MesoFit fit_meso(const std::vector<FitCase>& cases, const MesoSettings& start, const FitOptions& options);

}  // namespace stopline

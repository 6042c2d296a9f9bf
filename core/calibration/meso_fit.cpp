#include "calibration/meso_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>

#include <fmt/format.h>
#include <nlopt.hpp>

#include "base/random.h"
#include "base/simd/arithmetic.h"
#include "runs/interrupted.h"
#include "scenario/build_model.h"

namespace stopline {

namespace {

enum class LawSubset { constant_time, constant_distance, all };

// Returns true if all vehicles of the case use the same model: the constant-distance model if `constant_distance` is
// true, else the time-gap model.
bool has_law(const FitCase& c, bool constant_distance) {
    return std::all_of(c.model.following.begin(), c.model.following.end(), [&](const FollowingModel& model) {
        return model.is(constant_distance ? kConstantDistanceFamily : kTimeGapFamily);
    });
}

bool is_in(const FitCase& c, LawSubset subset) {
    if (c.held_out) return false;
    return subset == LawSubset::all || has_law(c, subset == LawSubset::constant_distance);
}

// A search for the minimum loss, and its state.
struct Search {
    std::vector<const FitCase*> cases;
    std::vector<std::size_t> free;  // indices of the fitted parameters in fit_parameters()
    std::vector<double> values;     // values of all parameters; fitted parameters as in the latest evaluation
    std::string stage;
    const FitOptions& options;
    MesoSettings settings;
    std::vector<FitEvaluation>& history;
    std::size_t planned;  // planned number of evaluations, all searches together
    std::exception_ptr error = {};

    double best_loss = 2.0;
    std::vector<double> best = {};

    double unscaled(std::size_t k, double x) const {
        const FitParameter& p = fit_parameters()[free[k]];
        return p.low + x * (p.high - p.low);
    }
    double scaled(std::size_t k) const {
        const FitParameter& p = fit_parameters()[free[k]];
        return std::clamp((values[free[k]] - p.low) / (p.high - p.low), 0.0, 1.0);
    }
};

MesoSettings with_values(MesoSettings settings, const std::vector<double>& values) {
    for (std::size_t k = 0; k < values.size(); ++k) fit_parameters()[k].value(settings) = values[k];
    // In the constant-distance model, the gap at rest is the sum of standstill_gap_m and band_m. The fit changes band_m
    // but must keep this sum, so standstill_gap_m is what remains of the sum.
    settings.constant_distance.standstill_gap_m = settings.calibrated_standstill_gap_m - settings.band_m;
    return settings;
}

double mean_loss(const Search& search, const MesoSettings& settings) {
    std::vector<double> losses(search.cases.size());
    const auto cases = static_cast<int>(search.cases.size());
#pragma omp parallel for schedule(dynamic) num_threads(search.options.threads)
    for (int k = 0; k < cases; ++k) {
        const FitCase& c = *search.cases[static_cast<std::size_t>(k)];
        const DetectorRun run = run_case(c, settings);
        const bool sound = run.violations.overlaps == 0 && run.violations.conflicts == 0;
        losses[static_cast<std::size_t>(k)] =
            sound ? fit_loss(pair_up(c.reference, run.times), search.options.limit_s) : 1.0;
    }
    double sum = 0.0;
    for (const double loss : losses) sum += loss;
    return sum / static_cast<double>(std::max<std::size_t>(losses.size(), 1));
}

double evaluate(Search& search) {
    const FitOptions& options = search.options;
    const std::size_t index = search.history.size();
    const auto done_share = static_cast<double>(index) / static_cast<double>(search.planned);
    if (options.on_progress && !options.on_progress(done_share)) throw Interrupted();
    MesoSettings settings = with_values(search.settings, search.values);
    for (std::size_t k = 0; k < search.values.size(); ++k) search.values[k] = fit_parameters()[k].value(settings);
    const std::optional<double> stored = options.stored_loss ? options.stored_loss(index, search.values) : std::nullopt;
    const double loss = stored ? *stored : mean_loss(search, settings);
    search.history.push_back({search.stage, search.values, loss});
    if (!stored && options.on_evaluation) options.on_evaluation(index, search.history.back());
    if (loss < search.best_loss) {
        search.best_loss = loss;
        search.best = search.values;
    }
    return loss;
}

// Returns the loss to NLopt. Stores any exception in the search, because NLopt does not pass on exceptions of other
// libraries.
double loss_of(const std::vector<double>& x, std::vector<double>& /*gradient*/, void* data) {
    auto& search = *static_cast<Search*>(data);
    try {
        for (std::size_t k = 0; k < x.size(); ++k) search.values[search.free[k]] = search.unscaled(k, x[k]);
        return evaluate(search);
    } catch (...) {
        search.error = std::current_exception();
        throw nlopt::forced_stop();
    }
}

// Improves the values with Rowan's subspace simplex (NLopt's SBPLX), which needs no gradient. The loss is not smooth:
// it jumps when one more vehicle passes in a green.
void improve(Search& search, double first_step, int evaluations) {
    nlopt::opt nlopt(nlopt::LN_SBPLX, static_cast<unsigned>(search.free.size()));
    nlopt.set_lower_bounds(0.0);
    nlopt.set_upper_bounds(1.0);
    nlopt.set_initial_step(first_step);
    nlopt.set_xtol_abs(1e-4);
    nlopt.set_maxeval(evaluations);
    nlopt.set_min_objective(loss_of, &search);
    std::vector<double> x;
    for (std::size_t k = 0; k < search.free.size(); ++k) x.push_back(search.scaled(k));
    double reached = 0.0;
    try {
        nlopt.optimize(x, reached);
    } catch (const nlopt::forced_stop&) {
        std::rethrow_exception(search.error);
    } catch (const nlopt::roundoff_limited&) {  // no further improvement is possible
    }
}

// Returns the parameter values at which search number `start` begins. Search 0 begins with the given values. All other
// searches begin with random values within the bounds.
std::vector<double> start_values(std::vector<double> values, const std::vector<std::size_t>& free, int start) {
    if (start == 0) return values;
    for (const std::size_t k : free) {
        const FitParameter& p = fit_parameters()[k];
        const double share = random_uniform(static_cast<std::uint64_t>(start), k, 0, Purpose::fit_start);
        values[k] = p.low + (0.1 + 0.8 * share) * (p.high - p.low);
    }
    return values;
}

}  // namespace

// Reasons for the bounds:
// - Deceleration: at most 7 m/s2, the limit on a dry road. The constant-distance model, whose reaction time is almost
//   0, gets at most 5 m/s2, so that its vehicles still stop at the line.
// - Anticipation: at most one step of 100 ms. With more, policies whose gap grows with speed oscillate.
// - Standstill gap (MesoSettings::constant_distance.standstill_gap_m): not fitted, but computed. It is the gap at rest
//   that the policy prescribes, minus the fitted MesoSettings::band_m.
const std::vector<FitParameter>& fit_parameters() {
    using S = MesoSettings;
    constexpr auto kNoProfile = [](const S& s) { return s.leader_profile_mps.empty(); };
    static const std::vector<FitParameter> kAll{
        {"start_delay", "s", false, 0.0, 1.0, [](S& s) -> double& { return s.start_delay_s; }},
        {"leader_acceleration", "m/s2", false, 0.8, 4.0, [](S& s) -> double& { return s.leader_mps2; }, kNoProfile},
        {"leader_constant_power_speed", "m/s", false, 2.0, 16.0,
         [](S& s) -> double& { return s.leader_constant_power_speed_mps; }, kNoProfile},
        {"constant_time.acceleration", "m/s2", false, 0.8, 4.0,
         [](S& s) -> double& { return s.constant_time.acceleration_mps2; }},
        {"constant_time.constant_power_speed", "m/s", false, 2.0, 16.0,
         [](S& s) -> double& { return s.constant_time.constant_power_speed_mps; }},
        {"constant_time.catch_up_factor", "", false, 1.0, 3.0,
         [](S& s) -> double& { return s.constant_time.catch_up_factor; }},
        {"constant_time.transient_gap", "", false, 0.0, 1.5,
         [](S& s) -> double& { return s.constant_time.transient_gap_s2; },
         [](const S& s) { return s.constant_time.gap_tracking == 0.0; }},
        {"constant_time.deceleration", "m/s2", false, 1.0, 7.0,
         [](S& s) -> double& { return s.constant_time.deceleration_mps2; }},
        {"constant_time.reaction", "s", false, 0.3, 1.3, [](S& s) -> double& { return s.constant_time.reaction_s; }},
        {"constant_time.dawdling", "", false, 0.0, 1.0, [](S& s) -> double& { return s.constant_time.dawdling; }},
        {"constant_distance.acceleration", "m/s2", true, 0.8, 4.0,
         [](S& s) -> double& { return s.constant_distance.acceleration_mps2; }},
        {"constant_distance.constant_power_speed", "m/s", true, 2.0, 16.0,
         [](S& s) -> double& { return s.constant_distance.constant_power_speed_mps; }},
        {"constant_distance.catch_up_factor", "", true, 1.0, 5.0,
         [](S& s) -> double& { return s.constant_distance.catch_up_factor; }},
        {"constant_distance.anticipation", "s", true, 0.0, 0.1,
         [](S& s) -> double& { return s.constant_distance.anticipation_s; }},
        {"constant_distance.deceleration", "m/s2", true, 1.0, 5.0,
         [](S& s) -> double& { return s.constant_distance.deceleration_mps2; }},
        {"constant_distance.reaction", "s", true, 0.0, 0.3,
         [](S& s) -> double& { return s.constant_distance.reaction_s; }},
        {"constant_distance.standstill_gap", "m", true, 0.0, 0.0,
         [](S& s) -> double& { return s.constant_distance.standstill_gap_m; }},
        {"constant_distance.dawdling", "", true, 0.0, 1.0,
         [](S& s) -> double& { return s.constant_distance.dawdling; }},
        {"band", "m", true, 0.05, 1.0, [](S& s) -> double& { return s.band_m; }},
        {"below_band_speed_share", "", true, 0.7, 1.0, [](S& s) -> double& { return s.below_band_speed_share; }},
    };
    return kAll;
}

DetectorRun run_case(const FitCase& fit_case, const MesoSettings& settings) {
    Model model = fit_case.model;
    set_meso(settings, model);
    return run_detectors(fit_case.scenario, model);
}

double fit_loss(const PairedTimes& pairs, double limit_s) {
    const double unpaired = pairs.unpaired_count();
    double sum = unpaired;
    for (const PassagePair& pair : pairs.pairs) {
        const double d2 = square(pair.difference_s());
        sum += d2 / (d2 + square(limit_s));
    }
    return sum / std::max(static_cast<double>(pairs.pairs.size()) + unpaired, 1.0);
}

MesoFit fit_meso(const std::vector<FitCase>& cases, const MesoSettings& start, const FitOptions& options) {
    MesoFit fit;
    fit.settings = start;
    std::vector<double> values;
    for (const FitParameter& p : fit_parameters()) values.push_back(p.value(fit.settings));

    const auto cases_of = [&](LawSubset subset) {
        std::vector<const FitCase*> chosen;
        for (const FitCase& c : cases) {
            if (is_in(c, subset)) chosen.push_back(&c);
        }
        return chosen;
    };
    const auto free_parameters = [&](LawSubset subset) {
        std::vector<std::size_t> free;
        for (std::size_t k = 0; k < fit_parameters().size(); ++k) {
            const FitParameter& p = fit_parameters()[k];
            if (!p.is_free(start)) continue;
            if (subset == LawSubset::all || p.constant_distance == (subset == LawSubset::constant_distance))
                free.push_back(k);
        }
        return free;
    };
    const auto planned =
        static_cast<std::size_t>(2 * options.starts * options.evaluations_per_start + options.joint_evaluations);

    for (const auto& [subset, name] : {std::pair{LawSubset::constant_time, "constant_time"},
                                       std::pair{LawSubset::constant_distance, "constant_distance"}}) {
        if (cases_of(subset).empty()) continue;
        double best_loss = 2.0;
        std::vector<double> best = values;
        for (int k = 0; k < options.starts; ++k) {
            Search search{cases_of(subset),
                          free_parameters(subset),
                          start_values(values, free_parameters(subset), k),
                          fmt::format("{} {}", name, k + 1),
                          options,
                          start,
                          fit.history,
                          planned};
            improve(search, 0.15, options.evaluations_per_start);
            if (search.best_loss >= best_loss) continue;
            best_loss = search.best_loss;
            best = search.best;
        }
        values = best;
    }
    Search search{
        cases_of(LawSubset::all), free_parameters(LawSubset::all), values, "all", options, start, fit.history, planned};
    improve(search, 0.05, options.joint_evaluations);
    fit.settings = with_values(start, search.best);
    return fit;
}

}  // namespace stopline

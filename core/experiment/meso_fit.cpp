#include "experiment/meso_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>

#include <fmt/format.h>
#include <nlopt.hpp>

#include "base/arithmetic.h"
#include "base/random.h"
#include "experiment/build_model.h"
#include "experiment/interrupted.h"

namespace stopline {

namespace {

enum class Subset { constant_time, constant_distance, all };

bool has_law(const FitCase& c, bool constant_distance) {
    return std::all_of(c.model.krauss.begin(), c.model.krauss.end(),
                       [&](const Krauss& k) { return k.constant_distance == constant_distance; });
}

bool belongs(const FitCase& c, Subset part) {
    if (c.held_out) return false;
    return part == Subset::all || has_law(c, part == Subset::constant_distance);
}

// All that one search needs.
struct Search {
    std::vector<const FitCase*> cases;
    std::vector<std::size_t> free;  // of fit_parameters()
    std::vector<double> values;     // of all parameters; the free ones are those last tried
    std::string stage;
    const FitOptions& options;
    MesoSettings settings;
    std::vector<FitEvaluation>& history;
    std::size_t planned;  // evaluations in all
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
    for (std::size_t k = 0; k < values.size(); ++k) fit_parameters()[k].in(settings) = values[k];
    // Vehicles stand as far apart as the policy says.
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
    const auto share = static_cast<double>(index) / static_cast<double>(search.planned);
    if (options.on_progress && !options.on_progress(share)) throw Interrupted();
    MesoSettings settings = with_values(search.settings, search.values);
    for (std::size_t k = 0; k < search.values.size(); ++k) search.values[k] = fit_parameters()[k].in(settings);
    const std::optional<double> known = options.known ? options.known(index, search.values) : std::nullopt;
    const double loss = known ? *known : mean_loss(search, settings);
    search.history.push_back({search.stage, search.values, loss});
    if (!known && options.on_evaluation) options.on_evaluation(index, search.history.back());
    if (loss < search.best_loss) {
        search.best_loss = loss;
        search.best = search.values;
    }
    return loss;
}

// NLopt lets no exception through but its own.
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

// Rowan's subspace simplex (NLopt's SBPLX): the loss has steps, wherever one vehicle more comes through a green.
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
    } catch (const nlopt::roundoff_limited&) {  // as good as it gets
    }
}

// The `start`-th start: 0 is what the settings say, others are spread over the bounds.
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

// Nobody brakes harder than 7 m/s2, what brakes give on a dry road; without a reaction time 5 m/s2 are what a vehicle reaches
// in time for a stop line. Nobody anticipates more than a step of 100 ms: beyond it policies whose gap grows with the speed
// swing. s_0 of the models with a time gap is what the policy says, and not fitted; in equation (1) s_0 is what s_t leaves of it.
const std::vector<FitParameter>& fit_parameters() {
    using S = MesoSettings;
    constexpr auto kNoProfile = [](const S& s) { return s.leader_profile_mps.empty(); };
    static const std::vector<FitParameter> kAll{
        {"start_delay", "s", false, 0.0, 1.0, [](S& s) -> double& { return s.start_delay_s; }},
        {"leader_acceleration", "m/s2", false, 0.8, 4.0, [](S& s) -> double& { return s.leader_mps2; }, kNoProfile},
        {"leader_acceleration_until", "m/s", false, 2.0, 16.0, [](S& s) -> double& { return s.leader_until_mps; },
         kNoProfile},
        {"constant_time.acceleration", "m/s2", false, 0.8, 4.0,
         [](S& s) -> double& { return s.constant_time.acceleration_mps2; }},
        {"constant_time.acceleration_until", "m/s", false, 2.0, 16.0,
         [](S& s) -> double& { return s.constant_time.acceleration_until_mps; }},
        {"constant_time.catch_up", "", false, 1.0, 3.0, [](S& s) -> double& { return s.constant_time.catch_up; }},
        {"constant_time.transient_gap", "", false, 0.0, 1.5,
         [](S& s) -> double& { return s.constant_time.transient_gap_s2; },
         [](const S& s) { return s.constant_time.tracking == 0.0; }},
        {"constant_time.deceleration", "m/s2", false, 1.0, 7.0,
         [](S& s) -> double& { return s.constant_time.deceleration_mps2; }},
        {"constant_time.reaction", "s", false, 0.3, 1.3, [](S& s) -> double& { return s.constant_time.reaction_s; }},
        {"constant_time.dawdling", "", false, 0.0, 1.0, [](S& s) -> double& { return s.constant_time.dawdling; }},
        {"constant_distance.acceleration", "m/s2", true, 0.8, 4.0,
         [](S& s) -> double& { return s.constant_distance.acceleration_mps2; }},
        {"constant_distance.acceleration_until", "m/s", true, 2.0, 16.0,
         [](S& s) -> double& { return s.constant_distance.acceleration_until_mps; }},
        {"constant_distance.catch_up", "", true, 1.0, 5.0,
         [](S& s) -> double& { return s.constant_distance.catch_up; }},
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
        {"below_band", "", true, 0.7, 1.0, [](S& s) -> double& { return s.below_band; }},
    };
    return kAll;
}

DetectorRun run_case(const FitCase& fit_case, const MesoSettings& settings) {
    Model model = fit_case.model;
    set_meso(fit_case.scenario, settings, model);
    return run_detectors(fit_case.scenario, model);
}

double fit_loss(const PairedTimes& pairs, double limit_s) {
    const double unpaired = pairs.unpaired_in_all();
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
    for (const FitParameter& p : fit_parameters()) values.push_back(p.in(fit.settings));

    const auto part = [&](Subset which) {
        std::vector<const FitCase*> chosen;
        for (const FitCase& c : cases) {
            if (belongs(c, which)) chosen.push_back(&c);
        }
        return chosen;
    };
    const auto parameters = [&](Subset which) {
        std::vector<std::size_t> free;
        for (std::size_t k = 0; k < fit_parameters().size(); ++k) {
            const FitParameter& p = fit_parameters()[k];
            if (!p.is_free(start)) continue;
            if (which == Subset::all || p.constant_distance == (which == Subset::constant_distance)) free.push_back(k);
        }
        return free;
    };
    const auto planned =
        static_cast<std::size_t>(2 * options.starts * options.evaluations_apart + options.evaluations_together);

    for (const auto& [which, name] : {std::pair{Subset::constant_time, "constant_time"},
                                      std::pair{Subset::constant_distance, "constant_distance"}}) {
        if (part(which).empty()) continue;
        double best_loss = 2.0;
        std::vector<double> best = values;
        for (int k = 0; k < options.starts; ++k) {
            Search search{part(which),
                          parameters(which),
                          start_values(values, parameters(which), k),
                          fmt::format("{} {}", name, k + 1),
                          options,
                          start,
                          fit.history,
                          planned};
            improve(search, 0.15, options.evaluations_apart);
            if (search.best_loss >= best_loss) continue;
            best_loss = search.best_loss;
            best = search.best;
        }
        values = best;
    }
    Search search{part(Subset::all), parameters(Subset::all), values, "all", options, start, fit.history, planned};
    improve(search, 0.05, options.evaluations_together);
    fit.settings = with_values(start, search.best);
    return fit;
}

}  // namespace stopline

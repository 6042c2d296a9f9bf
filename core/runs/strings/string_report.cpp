#include "runs/strings/string_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "base/nan.h"
#include "runs/parallel_runs.h"
#include "scenario/fleets.h"
#include "spacing_laws/gap_policy.h"
#include "v2v/platoon_length.h"

namespace stopline {

namespace {

// The runs of one population.
std::vector<Manoeuvre> manoeuvres_of(const StringOptions& options) {
    std::vector<Manoeuvre> all;
    for (const double frequency_radps : options.frequencies_radps) {
        all.push_back({Manoeuvre::Kind::swing, options.speed_mps, frequency_radps,
                       swing_amplitude_mps2(options, frequency_radps), options.deceleration_mps2});
    }
    if (options.brakes) all.push_back({Manoeuvre::Kind::brake, options.speed_mps, 0, 0, options.deceleration_mps2});
    if (options.starts) all.push_back({Manoeuvre::Kind::start, options.speed_mps});
    return all;
}

// The angular frequency of a swing whose period is a whole number of steps, as in drive_platoon().
double realised_frequency_radps(double frequency_radps, double step_s) {
    const double steps = std::max(2.0, std::round(2.0 * std::numbers::pi / (frequency_radps * step_s)));
    return 2.0 * std::numbers::pi / (steps * step_s);
}

struct RunOutcome {
    Manoeuvre manoeuvre;
    PlatoonMotion motion;  // without the samples of swings
    StringMeasures measures;
    SwingGain gain;
    double leader_amplitude_mps2 = 0.0;
};

RunOutcome run_one(const Scenario& scenario, std::size_t population, int vehicles, const Manoeuvre& manoeuvre,
                   const std::function<bool(double)>& report) {
    RunOutcome outcome;
    outcome.manoeuvre = manoeuvre;
    outcome.motion = drive_platoon(scenario, population, vehicles, manoeuvre, report);
    if (outcome.motion.samples == 0) return outcome;  // interrupted
    outcome.measures = measure_string(outcome.motion);
    if (manoeuvre.kind != Manoeuvre::Kind::swing) return outcome;
    outcome.manoeuvre.frequency_radps = realised_frequency_radps(manoeuvre.frequency_radps, outcome.motion.step_s);
    const std::vector<std::complex<double>> waves = amplitudes(outcome.motion, outcome.manoeuvre.frequency_radps);
    outcome.gain = swing_gain(waves, outcome.manoeuvre.frequency_radps);
    outcome.leader_amplitude_mps2 = std::abs(waves[0]);
    for (std::vector<float>* list : {&outcome.motion.acceleration_mps2, &outcome.motion.speed_mps,
                                     &outcome.motion.gap_m, &outcome.motion.gap_error_m}) {
        *list = {};
    }
    return outcome;
}

void add_outcome(RunOutcome& outcome, StringResult& result) {
    result.was_settled = result.was_settled && outcome.motion.was_settled;
    result.violations.add(outcome.motion.violations);
    result.updates += outcome.motion.updates;
    result.state_hashes.push_back(outcome.motion.state_hash);
    if (outcome.manoeuvre.kind == Manoeuvre::Kind::swing) {
        result.follower_lag_s += outcome.motion.follower_lag_s;
        result.swings.push_back({outcome.manoeuvre.frequency_radps, outcome.leader_amplitude_mps2, outcome.gain, kNan,
                                 std::move(outcome.measures)});
    } else {
        result.manoeuvres.push_back({outcome.manoeuvre.kind, std::move(outcome.measures), std::move(outcome.motion)});
    }
}

// Returns the gain that swing_gain() would measure in a platoon of linear vehicles. With messages of the platoon
// leader, the gain depends on the position.
double linear_gain(const Follower& follower, const SwingResult& swing, int followers) {
    std::vector<std::complex<double>> waves = follower.platoon_response(swing.frequency_radps, followers).acceleration;
    for (std::complex<double>& wave : waves) wave *= swing.leader_amplitude_mps2;
    return swing_gain(waves, swing.frequency_radps).mean;
}

// Returns the range of frequencies in which the linear model is compared with the swings.
FrequencyRange swing_range(const std::vector<SwingResult>& swings) {
    FrequencyRange range;
    range.high_radps = 0.0;
    for (const SwingResult& swing : swings) {
        range.low_radps = std::min(range.low_radps, swing.frequency_radps);
        range.high_radps = std::max(range.high_radps, swing.frequency_radps);
    }
    return range;
}

void add_linear_analysis(const Scenario& scenario, std::size_t population, double speed_mps, StringResult& result) {
    result.linear_peak = {kNan, kNan};
    result.stable_time_gap_s = kNan;
    if (result.swings.empty()) return;
    result.follower_lag_s /= static_cast<double>(result.swings.size());
    result.model = linear_model(scenario, population, speed_mps, result.follower_lag_s);
    if (!result.model) return;
    const Follower follower(*result.model);
    for (SwingResult& swing : result.swings) {
        swing.linear_gain = linear_gain(follower, swing, static_cast<int>(swing.measures.positions.size()) - 1);
    }
    result.range = swing_range(result.swings);
    result.linear_peak = peak_gain(follower, result.range);
    if (result.model->time_gap_s > 0.0) {
        result.stable_time_gap_s = smallest_stable_time_gap_s(*result.model, result.range);
    }
}

}  // namespace

std::vector<double> spaced_frequencies_radps(double low_radps, double high_radps, int count) {
    std::vector<double> all;
    for (int k = 0; k < count; ++k) all.push_back(low_radps * std::pow(high_radps / low_radps, k / (count - 1.0)));
    return all;
}

double default_string_speed_mps(const Scenario& scenario) {
    constexpr double kShareOfLimit = 0.7;
    return kShareOfLimit * scenario.network.approach.speed_limit_mps;
}

double swing_amplitude_mps2(const StringOptions& options, double frequency_radps) {
    constexpr double kSpeedShare = 0.15;
    constexpr double kJerk_mps3 = 0.6;
    return std::min(
        {options.amplitude_mps2, kSpeedShare * options.speed_mps * frequency_radps, kJerk_mps3 / frequency_radps});
}

const SwingResult* StringResult::worst_swing() const {
    const auto worst = std::max_element(swings.begin(), swings.end(), [](const SwingResult& a, const SwingResult& b) {
        return a.measured.mean < b.measured.mean;
    });
    return worst == swings.end() ? nullptr : &*worst;
}

bool StringReport::no_violations() const {
    return std::all_of(populations.begin(), populations.end(),
                       [](const StringResult& one) { return one.violations.none(); });
}

std::string manoeuvre_name(Manoeuvre::Kind kind) {
    switch (kind) {
        case Manoeuvre::Kind::swing:
            return "swing";
        case Manoeuvre::Kind::brake:
            return "brake";
        case Manoeuvre::Kind::start:
            break;
    }
    return "start";
}

std::optional<FollowerModel> linear_model(const Scenario& scenario, std::size_t population, double speed_mps,
                                          double lag_s) {
    const PopulationSettings& settings = scenario.populations[population];
    if (settings.components.size() != 1) return std::nullopt;
    const PopulationSettings::Component& component = settings.components[0];
    const auto known = std::find_if(scenario.policies.begin(), scenario.policies.end(),
                                    [&](const GapPolicySettings& one) { return one.name == component.policy; });
    if (known == scenario.policies.end()) return std::nullopt;
    const GapPolicy policy = make_gap_policy(*known);
    if (policy.law->is_human) return std::nullopt;
    double gap_m = 0.0;
    FollowerModel model;
    policy.evaluate({&speed_mps, 1}, {&gap_m, 1}, {&model.time_gap_s, 1});
    model.time_gap_s = std::max(0.0, model.time_gap_s);
    const DriverSettings& driver = driver_of(scenario, component);
    model.cacc = driver.cacc;
    model.cacc.v2v_delay_s = mean_message_age_s(driver, scenario.step_s);
    model.platoon_law = driver.v2v.platoon_law;
    if (driver.v2v.topology == "predecessor_and_leader" && model.time_gap_s == 0.0) {
        model.topology = Topology::leader_and_platoon_leader;
    }
    model.lag_s = lag_s;
    model.leader_lag_s = lag_s;
    // The driver knows the mean acceleration of the step before. Its middle is 1.5 steps before the end of this step,
    // when the request takes effect.
    model.acceleration_age_s = 1.5 * scenario.step_s;
    return model;
}

StringReport run_strings(const Scenario& scenario, const StringOptions& options) {
    check_platoon_scenario(scenario);
    const std::vector<Manoeuvre> manoeuvres = manoeuvres_of(options);
    std::vector<RunOutcome> outcomes(manoeuvres.size() * scenario.populations.size());
    run_side_by_side(outcomes.size(), options.threads, options.on_progress,
                     [&](std::size_t run, const std::function<bool(double)>& report) {
                         outcomes[run] = run_one(scenario, run / manoeuvres.size(), options.vehicles,
                                                 manoeuvres[run % manoeuvres.size()], report);
                     });
    StringReport report{scenario, options, {}};
    for (std::size_t population = 0; population < scenario.populations.size(); ++population) {
        StringResult result;
        result.population = scenario.populations[population].name;
        for (std::size_t k = 0; k < manoeuvres.size(); ++k) {
            add_outcome(outcomes[population * manoeuvres.size() + k], result);
        }
        add_linear_analysis(scenario, population, options.speed_mps, result);
        report.populations.push_back(std::move(result));
    }
    return report;
}

}  // namespace stopline

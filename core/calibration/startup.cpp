#include "calibration/startup.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include <boost/math/tools/minima.hpp>
#include <nlopt.hpp>

#include "base/input_error.h"
#include "base/units.h"
#include "driver/idm.h"
#include "runs/interrupted.h"
#include "runs/run.h"

namespace stopline {

namespace {

constexpr double kGreenStart_s = 60.0;
constexpr double kTrajectoryInterval_s = 0.01;
constexpr double kNoLeaderGap_m = 1e6;
constexpr double kLowerBound = 0.02;  // lower bound of all fitted parameters, m/s2 or 1/s

// Returns a scenario with one vehicle at one signal. The green lasts longer than the start.
Scenario single_start_scenario(const Scenario& scenario, double last_s) {
    Scenario lone = scenario;
    lone.demand.vehicles = 1;
    lone.network.approach.lanes = 1;
    lone.network.approach.length_m = 300.0;
    lone.network.approach.exit_length_m = std::max(2000.0, 1.2 * lone.network.approach.speed_limit_mps * last_s);
    lone.signal.first_green_s = kGreenStart_s;
    lone.signal.green_s = last_s + 20.0;
    lone.signal.cycle_s = 0.0;
    lone.duration_s = kGreenStart_s + last_s + 10.0;
    lone.populations.resize(1);
    return lone;
}

// Returns a value of the trajectory at a time, interpolated linearly.
double value_at(const std::vector<TrajectoryPoint>& points, double time_s, double TrajectoryPoint::*member) {
    const auto later = std::lower_bound(points.begin(), points.end(), time_s,
                                        [](const TrajectoryPoint& p, double t) { return p.time_s < t; });
    if (later == points.begin()) return points.front().*member;
    if (later == points.end()) return points.back().*member;
    const TrajectoryPoint& before = *(later - 1);
    const double share = (time_s - before.time_s) / (later->time_s - before.time_s);
    return before.*member + share * ((*later).*member - before.*member);
}

std::vector<double> knots_mps() {
    std::vector<double> knots;
    for (const double kmh : {0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 43.0, 46.0, 48.0, 49.0, 50.0}) {
        knots.push_back(kmh * kMpsPerKmh);
    }
    return knots;
}

// Returns the parameters at which the search starts: the accelerations at the knots (speeds of the profile), then the
// gain toward the desired speed. The accelerations are the slope of the measured mean speed times `factor`, so the
// result of the fit does not depend on the given driver.
std::vector<double> initial_parameters(const StartupCurve& curve, const std::vector<double>& knots, double factor,
                                       double gain_1ps) {
    SampledCurve slope;  // m/s2 over m/s
    for (std::size_t k = 1; k < curve.time_s.size(); ++k) {
        const double middle_mps = 0.5 * (curve.mean_mps[k] + curve.mean_mps[k - 1]);
        if (!slope.x.empty() && middle_mps <= slope.x.back()) continue;
        slope.x.push_back(middle_mps);
        slope.y.push_back((curve.mean_mps[k] - curve.mean_mps[k - 1]) / (curve.time_s[k] - curve.time_s[k - 1]));
    }
    std::vector<double> values;
    for (const double speed : knots) values.push_back(factor * interpolate(slope, speed));
    values.push_back(gain_1ps);
    return values;
}

void set_parameters(const std::vector<double>& values, FreeDriveSettings& free) {
    free.acceleration_mps2.assign(values.begin(), values.end() - 1);
    free.speed_gain_1ps = values.back();
}

struct FitTask {
    Scenario scenario;
    const StartupCurve* curve = nullptr;
    const std::function<bool(int)>* on_progress = nullptr;
    int evaluations = 0;
    std::exception_ptr error = {};  // exception that ended the search
};

// Returns the deviation to NLopt. Stores any exception in the task, because NLopt does not pass on exceptions of other
// libraries.
double deviation(const std::vector<double>& parameters, std::vector<double>& /*gradient*/, void* data) {
    auto& task = *static_cast<FitTask*>(data);
    try {
        set_parameters(parameters, task.scenario.driver.free_drive);
        const double rms = rms_deviation_mps(*task.curve, simulate_start(task.scenario, task.curve->time_s));
        ++task.evaluations;
        if (*task.on_progress && !(*task.on_progress)(task.evaluations)) throw Interrupted();
        return rms;
    } catch (...) {
        task.error = std::current_exception();
        throw nlopt::forced_stop();
    }
}

// Improves the parameters by one search and returns the rms deviation reached, m/s.
double search_from(std::vector<double>& parameters, FitTask& task) {
    constexpr int kMaxEvaluations = 500;
    nlopt::opt search(nlopt::LN_BOBYQA, static_cast<unsigned>(parameters.size()));
    search.set_lower_bounds(kLowerBound);
    search.set_upper_bounds(task.scenario.driver.cacc.acceleration_max_mps2);
    search.set_min_objective(deviation, &task);
    search.set_initial_step(0.2);
    search.set_xtol_abs(1e-3);
    search.set_maxeval(kMaxEvaluations);
    double reached = 0.0;
    try {
        search.optimize(parameters, reached);
    } catch (const nlopt::forced_stop&) {
        std::rethrow_exception(task.error);
    }
    return reached;
}

}  // namespace

StartupRun simulate_start(const Scenario& scenario, const std::vector<double>& times_s) {
    const Scenario lone = single_start_scenario(scenario, times_s.back());
    RunOptions options;
    options.trajectory_interval_s = std::max(kTrajectoryInterval_s, lone.tick_s());
    options.trajectory_from_s = kGreenStart_s;
    const RunResult result = run_population(lone, 0, options);
    const std::vector<TrajectoryPoint>& points = result.trajectory;
    const auto moving =
        std::find_if(points.begin(), points.end(), [](const TrajectoryPoint& p) { return p.speed_mps >= kMoving_mps; });
    if (moving == points.end())
        throw InputError("start-up: the vehicle never moves; check the driver and vehicle files");
    StartupRun run;
    const double begin_m = points.front().distance_m;
    for (const double t : times_s) {
        const double time_s = moving->time_s + t;
        run.time_s.push_back(t);
        run.speed_mps.push_back(value_at(points, time_s, &TrajectoryPoint::speed_mps));
        run.distance_m.push_back(value_at(points, time_s, &TrajectoryPoint::distance_m) - begin_m);
        const auto point = std::lower_bound(points.begin(), points.end(), time_s,
                                            [](const TrajectoryPoint& p, double at_s) { return p.time_s < at_s; });
        run.gear.push_back(point == points.end() ? points.back().gear : point->gear);
    }
    return run;
}

double rms_deviation_mps(const StartupCurve& curve, const StartupRun& run) {
    double sum = 0.0;
    for (std::size_t k = 0; k < curve.time_s.size(); ++k) {
        sum += (run.speed_mps[k] - curve.mean_mps[k]) * (run.speed_mps[k] - curve.mean_mps[k]);
    }
    return std::sqrt(sum / static_cast<double>(curve.time_s.size()));
}

double idm_deviation_mps(const StartupCurve& curve, double acceleration_mps2, double desired_mps) {
    constexpr double kIdmStep_s = 0.01;
    const IdmParameters idm = idm_parameters({.acceleration_mps2 = acceleration_mps2}, 0.0, 0.0);
    StartupRun run;
    double speed_mps = 0.0;
    long step = 0;
    for (const double at_s : curve.time_s) {
        for (const long until = std::lround(at_s / kIdmStep_s); step < until; ++step)
            speed_mps += kIdmStep_s * idm_acceleration_mps2(idm, speed_mps, 0.0, kNoLeaderGap_m, desired_mps);
        run.speed_mps.push_back(speed_mps);
    }
    return rms_deviation_mps(curve, run);
}

double fit_idm_acceleration_mps2(const StartupCurve& curve, double desired_mps) {
    constexpr double kLowest_mps2 = 0.1;
    constexpr double kHighest_mps2 = 10.0;
    constexpr int kBits = 20;  // precision of the result
    const auto deviation_mps = [&](double mps2) { return idm_deviation_mps(curve, mps2, desired_mps); };
    return boost::math::tools::brent_find_minima(deviation_mps, kLowest_mps2, kHighest_mps2, kBits).first;
}

StartupFit fit_startup(const Scenario& scenario, const StartupCurve& curve,
                       const std::function<bool(int)>& on_progress) {
    FitTask task{scenario, &curve, &on_progress};
    FreeDriveSettings& free = task.scenario.driver.free_drive;
    const std::vector<double> knots = knots_mps();
    StartupFit fit;
    fit.rms_before_mps = rms_deviation_mps(curve, simulate_start(scenario, curve.time_s));
    free.speed_mps = knots;

    // The deviation has several minima, because the times of gear changes depend on the profile. The search therefore
    // starts at several points, and the best result is kept.
    std::vector<double> best_parameters;
    double best = 1e9;
    for (const double factor : {0.95, 1.0, 1.05, 1.1, 1.15, 1.2}) {
        for (const double gain_1ps : {0.4, 0.6}) {
            std::vector<double> parameters = initial_parameters(curve, knots, factor, gain_1ps);
            for (double& value : parameters) {
                value = std::clamp(value, kLowerBound, scenario.driver.cacc.acceleration_max_mps2);
            }
            const double reached = search_from(parameters, task);
            if (reached < best) {
                best = reached;
                best_parameters = parameters;
            }
        }
    }
    std::vector<double>& parameters = best_parameters;
    // Round the parameters to the precision of the driver file.
    for (double& value : parameters) value = std::round(value * 1e3) / 1e3;
    set_parameters(parameters, free);
    fit.driver = task.scenario.driver;
    const double idm_mps2 = fit_idm_acceleration_mps2(curve, scenario.network.approach.speed_limit_mps);
    fit.driver.human.idm.acceleration_mps2 = std::round(idm_mps2 * 1e3) / 1e3;
    fit.rms_after_mps = rms_deviation_mps(curve, simulate_start(task.scenario, curve.time_s));
    fit.evaluations = task.evaluations;
    return fit;
}

std::vector<BandExit> band_exits(const StartupCurve& curve, const StartupRun& run, bool of_mean) {
    std::vector<BandExit> exits;
    if (of_mean ? curve.mean_ci_mps.empty() : curve.low_mps.empty()) return exits;
    const auto measured_mps = [&](const std::vector<double>& values_mps, double time_s) {
        return interpolate({curve.time_s, values_mps}, time_s);
    };
    bool outside_before = false;
    for (std::size_t k = 0; k < run.time_s.size(); ++k) {
        const double time_s = run.time_s[k];
        const double speed_mps = run.speed_mps[k];
        const double deviation_mps = speed_mps - measured_mps(curve.mean_mps, time_s);
        const bool outside = of_mean ? std::fabs(deviation_mps) > measured_mps(curve.mean_ci_mps, time_s)
                                     : speed_mps < measured_mps(curve.low_mps, time_s) ||
                                           speed_mps > measured_mps(curve.high_mps, time_s);
        // If two successive samples are outside the band on opposite sides, the speed has crossed the band: a new exit
        // begins.
        const bool crossed = outside_before && deviation_mps * exits.back().largest_deviation_mps < 0.0;
        if (outside && (!outside_before || crossed)) exits.push_back({time_s, time_s, deviation_mps});
        if (outside) {
            BandExit& exit = exits.back();
            exit.to_s = time_s;
            if (std::fabs(deviation_mps) > std::fabs(exit.largest_deviation_mps))
                exit.largest_deviation_mps = deviation_mps;
        }
        outside_before = outside;
    }
    return exits;
}

}  // namespace stopline

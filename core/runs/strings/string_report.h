// The experiment of stopline-strings: each population of a scenario drives as a platoon behind a leader that swings,
// brakes hard, or starts from rest. The report compares measured gains with those of the linear analysis
// (string_stability).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runs/strings/string_measures.h"
#include "string_stability/string_limits.h"

namespace stopline {

struct StringOptions {
    int threads = 1;
    int vehicles = 20;  // platoon leader and followers
    double speed_mps = 0.0;
    double amplitude_mps2 = 0.3;
    double deceleration_mps2 = 6.0;
    std::vector<double> frequencies_radps;  // swings; empty: none
    bool brakes = true;
    bool starts = true;
    std::function<bool(double)> on_progress;  // gets the completed share, 0 .. 1; returns false to stop
};

// Returns `count` frequencies from `low_radps` to `high_radps`, equally spaced on a logarithmic scale.
std::vector<double> spaced_frequencies_radps(double low_radps, double high_radps, int count);

// Returns the speed around which the leader swings by default. It leaves the followers room below the speed limit.
double default_string_speed_mps(const Scenario& scenario);

// Returns the amplitude of the leader's acceleration. It is limited so that the speed of the leader varies by at most
// 15 %, and so that a fast swing stays far below the limit of the jerk.
double swing_amplitude_mps2(const StringOptions& options, double frequency_radps);

struct SwingResult {
    double frequency_radps = 0.0;
    double leader_amplitude_mps2 = 0.0;  // realised by the platoon leader
    SwingGain measured;
    double linear_gain = 0.0;  // NaN without a linear model
    StringMeasures measures;
};

// The result of one hard braking or one start.
struct ManoeuvreResult {
    Manoeuvre::Kind kind = Manoeuvre::Kind::brake;
    StringMeasures measures;
    PlatoonMotion motion;
};

struct StringResult {
    std::string population;
    double follower_lag_s = 0.0;         // mean lag of the powertrains of the followers in the swings
    std::optional<FollowerModel> model;  // absent: mixed population or human drivers
    FrequencyRange range;                // of the linear analysis: up to the highest frequency of the swings
    GainPeak linear_peak;                // of the linear model; gain NaN without one
    double stable_time_gap_s =
        0.0;  // smallest time gap of the linear model; NaN without a model or with a constant distance
    std::vector<SwingResult> swings;  // in the order of StringOptions::frequencies_radps
    std::vector<ManoeuvreResult> manoeuvres;
    bool was_settled = true;  // false: a platoon had not reached its equilibrium before a manoeuvre
    Violations violations;
    std::int64_t updates = 0;
    std::vector<std::uint64_t> state_hashes;  // of all runs, swings first

    // Returns the swing with the largest measured gain; null without swings.
    const SwingResult* worst_swing() const;
};

struct StringReport {
    Scenario scenario;
    StringOptions options;
    std::vector<StringResult> populations;

    bool no_violations() const;
};

// Returns the name of a manoeuvre, such as "brake".
std::string manoeuvre_name(Manoeuvre::Kind kind);

// Runs all populations. Throws InputError if the scenario is unsuitable, and Interrupted if on_progress returns false.
StringReport run_strings(const Scenario& scenario, const StringOptions& options);

// Returns the linear model of a follower in a population, with the slope of its spacing policy at the given speed and
// with the mean age of its messages. Returns nothing for mixed populations and for human drivers.
std::optional<FollowerModel> linear_model(const Scenario& scenario, std::size_t population, double speed_mps,
                                          double lag_s);

}  // namespace stopline

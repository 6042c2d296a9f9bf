// Comfort and surrogate safety of a run (measure.surrogate_safety): jerk, hard braking, time to collision, brake threat
// number, and gaps. All values come from samples every 0.1 s.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "base/nan.h"

namespace stopline {

// The distributions of a run.
enum class SafetyMeasure : std::uint8_t { jerk, acceleration, time_to_collision, brake_threat, net_gap, time_gap };
inline constexpr std::size_t kSafetyMeasures = 6;

// Name and bins of a distribution. The first and the last bin also hold all values beyond them.
struct SafetyAxis {
    std::string_view name;
    std::string_view label;  // axis of the figure
    double from;
    double width;
    int bins;
};
inline constexpr std::array<SafetyAxis, kSafetyMeasures> kSafetyAxes{
    SafetyAxis{"jerk_mps3", "jerk [m/s^3]", -50.0, 0.2, 500},
    SafetyAxis{"acceleration_mps2", "acceleration [m/s^2]", -10.0, 0.1, 150},
    SafetyAxis{"time_to_collision_s", "time to collision [s]", 0.0, 0.25, 80},
    SafetyAxis{"brake_threat", "brake threat number", 0.0, 0.02, 100},
    SafetyAxis{"net_gap_m", "net gap [m]", 0.0, 0.5, 120},
    SafetyAxis{"time_gap_s", "time gap [s]", 0.0, 0.1, 100}};

inline constexpr double kHardBrakingBegin_mps2 = -3.0;
// A further event of hard braking begins only after the deceleration has been below this value.
inline constexpr double kHardBrakingEnd_mps2 = -2.0;
inline constexpr double kCriticalTtc_s = 1.5;
inline constexpr double kShortTtc_s = 3.0;

class SafetyDistribution {
public:
    SafetyDistribution() = default;
    explicit SafetyDistribution(const SafetyAxis& axis) : axis_(axis), samples_(static_cast<std::size_t>(axis.bins)) {}

    void add(double value);
    // Returns the value below which a share of the samples lies, with the resolution of the bins; NaN without samples.
    double quantile(double share) const;
    double smallest() const { return count_ > 0 ? smallest_ : kNan; }
    double largest() const { return count_ > 0 ? largest_ : kNan; }
    std::int64_t count() const { return count_; }
    const std::vector<std::int64_t>& samples() const { return samples_; }  // [bin]

private:
    SafetyAxis axis_{};
    std::vector<std::int64_t> samples_;
    std::int64_t count_ = 0;
    double smallest_ = std::numeric_limits<double>::infinity();
    double largest_ = -std::numeric_limits<double>::infinity();
};

struct SafetyResult {
    bool exists = false;                                            // measure.surrogate_safety is on
    double sample_s = 0.1;                                          // time between samples
    std::array<SafetyDistribution, kSafetyMeasures> distributions;  // [SafetyMeasure]
    double vehicle_km = 0.0;
    std::int64_t hard_brakings = 0;
    std::int64_t following = 0;     // samples of moving vehicles behind a leader
    std::int64_t critical_ttc = 0;  // of these, samples with a time to collision below kCriticalTtc_s
    std::int64_t short_ttc = 0;     // of these, samples below kShortTtc_s

    const SafetyDistribution& of(SafetyMeasure measure) const {
        return distributions[static_cast<std::size_t>(measure)];
    }
    double following_percent(std::int64_t samples) const {
        return following > 0 ? 100.0 * static_cast<double>(samples) / static_cast<double>(following) : kNan;
    }
};

// The motion of a vehicle and of its leader.
struct FollowingState {
    double net_gap_m = 0.0;
    double speed_mps = 0.0;
    double leader_mps = 0.0;
    double leader_mps2 = 0.0;  // acceleration of the leader
};

// Returns the time until contact at constant speeds. Infinite if the vehicle does not approach its leader.
double time_to_collision_s(const FollowingState& state);

// Returns the constant deceleration with which the vehicle just avoids its leader. The leader keeps its acceleration,
// or stops with it. The result is 0 if the vehicle need not brake. The brake threat number is this deceleration over
// the available one (Brannstrom, Sjoberg and Coelingh 2008).
double required_deceleration_mps2(const FollowingState& state);

}  // namespace stopline

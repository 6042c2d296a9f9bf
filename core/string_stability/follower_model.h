// The linear model of a vehicle in a platoon. It is the linearised controller of full dynamics
// (driver/acceleration_laws.h), with the delays of radar and V2V and with a first-order lag of the powertrain. Limits
// of acceleration and jerk, gear changes, emergency braking and the step length are not part of it.
#pragma once

#include <complex>
#include <vector>

#include "driver/driver_settings.h"
#include "string_stability/delay_system.h"
#include "string_stability/kalman_filter.h"

namespace stopline {

// The vehicles whose acceleration a vehicle knows, and how it knows it.
enum class Topology {
    radar,                      // none: adaptive cruise control (ACC)
    estimated_leader,           // the leader, estimated from radar by a Kalman filter: degraded CACC (dCACC)
    leader,                     // the leader, by V2V: CACC with the spacing laws of the paper
    leader_and_platoon_leader,  // both, by V2V: Rajamani's law for a constant distance
};

struct FollowerModel {
    Topology topology = Topology::leader;
    CaccSettings cacc;                // gains, delays of radar and V2V, horizon of the predictive feedforward
    double time_gap_s = 0.0;          // slope of the spacing law; 0: constant distance
    double lag_s = 0.1;               // lag of the own powertrain
    double leader_lag_s = 0.1;        // lag of the powertrain of the leader
    double acceleration_age_s = 0.0;  // age of the own acceleration when the request that uses it takes effect
    PlatoonLawSettings platoon_law;   // Rajamani's law for a constant distance
    SingerModel singer;
};

// The acceleration of a vehicle for a unit acceleration of its leader and of its platoon leader, at one frequency.
struct FrequencyResponse {
    std::complex<double> to_leader;
    std::complex<double> to_platoon_leader;  // 0 unless the topology has a platoon leader
};

// The accelerations and gap errors in a platoon of equal vehicles, for a unit acceleration of the platoon leader.
struct PlatoonResponse {
    std::vector<std::complex<double>> acceleration;  // [position] 1 for the platoon leader
    std::vector<std::complex<double>> gap_error_m;   // [position] per m/s2; 0 for the platoon leader
};

// The transfer function Gamma(s) of one vehicle.
class Follower {
public:
    explicit Follower(const FollowerModel& model);

    // Returns the responses to an oscillation with the given angular frequency, which must be above 0.
    FrequencyResponse response(double frequency_radps) const;
    // Returns the response of the platoon leader and of `followers` vehicles behind it.
    PlatoonResponse platoon_response(double frequency_radps, int followers) const;
    // Returns true if the vehicle returns to its gap after a disturbance. Otherwise its response has no meaning.
    bool is_stable() const { return system_.unstable_roots() == 0; }

private:
    FollowerModel model_;
    DelaySystem system_;
};

}  // namespace stopline

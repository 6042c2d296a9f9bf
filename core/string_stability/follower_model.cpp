#include "string_stability/follower_model.h"

#include <cmath>

#include "driver/acceleration_laws.h"

namespace stopline {

namespace {

using Complex = std::complex<double>;

// State variables of the vehicle. A topology without estimator has no estimated values, and a vehicle with a constant
// distance has no filter.
enum State { position, speed, acceleration, request, estimate };
// Signals of the leader and of the platoon leader.
enum Input { leader_position, leader_speed, leader_acceleration, leader_request, platoon_speed, platoon_acceleration };
constexpr int kInputs = 6;

// The desired acceleration of a linear law: the sum of these gains times the deviations from the equilibrium.
struct LawGains {
    double gap_1ps2 = 0.0;
    double closing_1ps = 0.0;
    double speed_1ps = 0.0;
    double acceleration = 0.0;
    double leader_acceleration = 0.0;
    double leader_request = 0.0;
    double platoon_leader_speed_1ps = 0.0;  // own speed minus that of the platoon leader
    double platoon_leader_acceleration = 0.0;
};

// Returns the desired acceleration of follow_acceleration() for small deviations from the equilibrium. With a time gap
// it is the value that the filter 1 / H approaches.
double desired_acceleration_mps2(const FollowerModel& m, double speed_mps, double acceleration_mps2,
                                 const LeaderView<double>& leader) {
    constexpr double kEquilibriumSpeed_mps = 20.0;
    constexpr double kGap_m = 10.0;
    const double desired_gap_m = kGap_m + m.time_gap_s * speed_mps;
    // With a time gap, lag_share() is 1 for this step length, so the filter takes the new value at once.
    const double step_s = m.time_gap_s > 0.0 ? 2.0 * m.time_gap_s : 0.01;
    LeaderView<double> p = leader;
    p.gap_m += kGap_m;
    return follow_acceleration<double>(m.cacc, kEquilibriumSpeed_mps + speed_mps, acceleration_mps2, m.lag_s,
                                       1.0 / m.lag_s, 0.0, desired_gap_m, kEquilibriumSpeed_mps, m.time_gap_s, p,
                                       step_s);
}

// Returns the gains of follow_acceleration(). Around the equilibrium the law is linear, so the quotients are exact.
LawGains gains_of_spacing_law(const FollowerModel& m) {
    constexpr double kSmall = 1e-3;
    const LeaderView<double> none{0.0, 0.0, 0.0, 0.0, 1.0 / m.leader_lag_s};
    const auto with = [&](double LeaderView<double>::*member) {
        LeaderView<double> changed = none;
        changed.*member = kSmall;
        return desired_acceleration_mps2(m, 0.0, 0.0, changed) / kSmall;
    };
    LawGains gains;
    gains.gap_1ps2 = with(&LeaderView<double>::gap_m);
    gains.closing_1ps = with(&LeaderView<double>::closing_mps);
    gains.speed_1ps = desired_acceleration_mps2(m, kSmall, 0.0, none) / kSmall;
    gains.acceleration = desired_acceleration_mps2(m, 0.0, kSmall, none) / kSmall;
    gains.leader_acceleration = with(&LeaderView<double>::acceleration_mps2);
    gains.leader_request = with(&LeaderView<double>::request_mps2);
    return gains;
}

// Returns the gains without the feedforward of V2V. The feedforward of a constant distance also depends on the own
// acceleration. The feedback depends on it only through the time gap.
LawGains without_feedforward(LawGains gains, const FollowerModel& m) {
    gains.leader_acceleration = 0.0;
    gains.leader_request = 0.0;
    gains.acceleration = -m.cacc.feedback_kd_1ps * m.time_gap_s;
    return gains;
}

// Returns the gains of Rajamani's law:
//     u = (1 - C1) a_p + C1 a_0 - (2 xi - C1 k) wn (v - v_p) - k wn C1 (v - v_0) - wn^2 (desired gap - gap)
// with k = xi + sqrt(xi^2 - 1).
LawGains gains_of_platoon_law(const PlatoonLawSettings& law) {
    const double k = law.damping + std::sqrt(law.damping * law.damping - 1.0);
    LawGains gains;
    gains.gap_1ps2 = law.bandwidth_1ps * law.bandwidth_1ps;
    gains.closing_1ps = -(2.0 * law.damping - law.leader_weight * k) * law.bandwidth_1ps;
    gains.leader_acceleration = 1.0 - law.leader_weight;
    gains.platoon_leader_acceleration = law.leader_weight;
    gains.platoon_leader_speed_1ps = -k * law.bandwidth_1ps * law.leader_weight;
    return gains;
}

LawGains gains_of(const FollowerModel& m) {
    switch (m.topology) {
        case Topology::leader:
            return gains_of_spacing_law(m);
        case Topology::leader_and_platoon_leader:
            return gains_of_platoon_law(m.platoon_law);
        case Topology::radar:
        case Topology::estimated_leader:
            break;
    }
    return without_feedforward(gains_of_spacing_law(m), m);
}

// Adds `factor` times the desired acceleration to the derivative of the state `row`. The radar measures gap and closing
// speed. The V2V messages carry accelerations, requests and the speed of the platoon leader.
void add_law(const FollowerModel& m, const LawGains& gains, int row, double factor, DelaySystem& system) {
    const double radar_s = m.cacc.radar_delay_s;
    const double v2v_s = m.cacc.v2v_delay_s;
    system.add_input(row, leader_position, factor * gains.gap_1ps2, radar_s);
    system.add_state(row, position, -factor * gains.gap_1ps2, radar_s);
    system.add_input(row, leader_speed, -factor * gains.closing_1ps, radar_s);
    system.add_state(row, speed, factor * gains.closing_1ps, radar_s);
    system.add_state(row, speed, factor * gains.speed_1ps);
    system.add_state(row, acceleration, factor * gains.acceleration, m.acceleration_age_s);
    system.add_input(row, leader_acceleration, factor * gains.leader_acceleration, v2v_s);
    system.add_input(row, leader_request, factor * gains.leader_request, v2v_s);
    system.add_state(row, speed, factor * gains.platoon_leader_speed_1ps);
    system.add_input(row, platoon_speed, -factor * gains.platoon_leader_speed_1ps, v2v_s);
    system.add_input(row, platoon_acceleration, factor * gains.platoon_leader_acceleration, v2v_s);
}

// Adds the Kalman filter, whose first state is `first`, and its estimate of the leader's acceleration to the derivative
// of the state `row`.
void add_estimator(const FollowerModel& m, int first, int row, double factor, DelaySystem& system) {
    const SteadyKalmanFilter filter = steady_kalman_filter(m.singer);
    for (int i = 0; i < kEstimatedStates; ++i) {
        const auto& transition = filter.transition[static_cast<std::size_t>(i)];
        for (int k = 0; k < kEstimatedStates; ++k) {
            system.add_state(first + i, first + k, transition[static_cast<std::size_t>(k)]);
        }
        const auto& gain = filter.gain[static_cast<std::size_t>(i)];
        system.add_input(first + i, leader_position, gain[0], m.cacc.radar_delay_s);
        system.add_input(first + i, leader_speed, gain[1], m.cacc.radar_delay_s);
    }
    system.add_state(row, first + kEstimatedStates - 1, factor);
}

DelaySystem system_of(const FollowerModel& m) {
    const bool has_filter = m.time_gap_s > 0.0 && m.topology != Topology::leader_and_platoon_leader;
    const bool has_estimator = m.topology == Topology::estimated_leader;
    const int filter_states = has_filter ? 1 : 0;
    DelaySystem system(3 + filter_states + (has_estimator ? kEstimatedStates : 0), kInputs);
    system.add_state(position, speed, 1.0);
    system.add_state(speed, acceleration, 1.0);
    system.add_state(acceleration, acceleration, -1.0 / m.lag_s);
    int row = acceleration;
    double factor = 1.0 / m.lag_s;
    if (has_filter) {
        system.add_state(acceleration, request, 1.0 / m.lag_s);
        system.add_state(request, request, -1.0 / m.time_gap_s);
        row = request;
        factor = 1.0 / m.time_gap_s;
    }
    add_law(m, gains_of(m), row, factor, system);
    if (has_estimator) add_estimator(m, 3 + filter_states, row, factor, system);
    return system;
}

}  // namespace

Follower::Follower(const FollowerModel& model) : model_(model), system_(system_of(model)) {}

FrequencyResponse Follower::response(double frequency_radps) const {
    const Complex s(0.0, frequency_radps);
    const std::vector<Complex> leader{1.0 / (s * s), 1.0 / s, 1.0, 1.0 + s * model_.leader_lag_s, 0.0, 0.0};
    FrequencyResponse response{system_.states(s, leader)[acceleration], 0.0};
    if (model_.topology == Topology::leader_and_platoon_leader) {
        response.to_platoon_leader = system_.states(s, {0.0, 0.0, 0.0, 0.0, 1.0 / s, 1.0})[acceleration];
    }
    return response;
}

PlatoonResponse Follower::platoon_response(double frequency_radps, int followers) const {
    const Complex s(0.0, frequency_radps);
    const FrequencyResponse one = response(frequency_radps);
    const double time_gap_s = model_.topology == Topology::leader_and_platoon_leader ? 0.0 : model_.time_gap_s;
    PlatoonResponse platoon{{1.0}, {0.0}};
    for (int k = 0; k < followers; ++k) {
        const Complex ahead = platoon.acceleration.back();
        const Complex own = one.to_leader * ahead + one.to_platoon_leader;
        platoon.acceleration.push_back(own);
        platoon.gap_error_m.push_back((ahead - own) / (s * s) - time_gap_s * own / s);
    }
    return platoon;
}

}  // namespace stopline

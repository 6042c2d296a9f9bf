// Radar and V2V of the reference engine in full dynamics: data about the leader, with their delays.
#pragma once

#include "reference/world.h"

namespace stopline::reference_engine {

// The data of radar and V2V about the leader.
struct View {
    double gap_m = kNoLeaderGap_m;
    double closing_mps = 0.0;
    double acceleration_mps2 = 0.0;
    double request_mps2 = 0.0;
    double rate_1ps = 1.0;  // 1 / lag of the leader
};

inline double mixed(double a, double b, double share_of_b) { return (1.0 - share_of_b) * a + share_of_b * b; }
inline RadarSample mixed(const RadarSample& a, const RadarSample& b, double share_of_b) {
    return {mixed(a.gap_m, b.gap_m, share_of_b), mixed(a.closing_mps, b.closing_mps, share_of_b)};
}
inline Message mixed(const Message& a, const Message& b, double share_of_b) {
    return {mixed(a.acceleration_mps2, b.acceleration_mps2, share_of_b),
            mixed(a.request_mps2, b.request_mps2, share_of_b), mixed(a.rate_1ps, b.rate_1ps, share_of_b)};
}

// Returns the sample that is `age` steps old, interpolated between two samples. The first sample of the history is
// `newest_age` steps old.
template <class Sample>
Sample sample_of_age(const std::deque<Sample>& history, double age, std::size_t newest_age) {
    constexpr double kRounding = 1e-9;
    const double steps = std::floor(age + kRounding);
    const double share = age - steps > kRounding ? age - steps : 0.0;
    const std::size_t younger = static_cast<std::size_t>(steps) - newest_age;
    return mixed(history[younger], history[younger + 1], share);
}

// Returns the delayed data about the leader. The ages are in steps. The radar has measured in this step already, but
// the newest message is that of the previous step.
inline View view_of(const Vehicle& v, const Leader& leader, double radar_age, double v2v_age) {
    const RadarSample radar = sample_of_age(v.radar, radar_age, 0);
    View view;
    view.gap_m = radar.gap_m;
    view.closing_mps = radar.closing_mps;
    if (leader.vehicle == nullptr) return view;
    const Message heard = sample_of_age(leader.vehicle->sent, v2v_age, 1);
    view.acceleration_mps2 = heard.acceleration_mps2;
    view.request_mps2 = heard.request_mps2;
    view.rate_1ps = heard.rate_1ps;
    return view;
}

}  // namespace stopline::reference_engine

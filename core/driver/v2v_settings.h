// The user's settings of V2V communication: the radio channel, and the driving of a vehicle that misses messages. SI
// units. The constant delay of messages is CaccSettings::v2v_delay_s.
#pragma once

#include <string>
#include <vector>

namespace stopline {

// Share of delivered messages over distance, for one density of vehicles.
struct DeliveryCurve {
    double density_vpkm = 0.0;  // vehicles per km of road
    std::vector<double> distance_m;
    std::vector<double> delivered;

    bool operator==(const DeliveryCurve&) const = default;
};

// The curves of a radio technology, ordered by density. Files in data/v2v.
struct DeliverySettings {
    std::string name;
    std::vector<DeliveryCurve> curves;

    bool operator==(const DeliverySettings&) const = default;
};

// Driving without recent messages. The vehicle falls back step by step, with the age of the newest message
// (v2v/fallback.h).
struct FallbackSettings {
    // Time gap without any estimate of the leader's acceleration (ACC): the shortest one of the range from 1.5 s to
    // 2.2 s, of which ISO 15622:2018 demands one. A string-stable ACC with the default gains would need 3.16 s, and
    // 3.31 s with a radar delay of 0.15 s.
    double acc_time_gap_s = 1.5;
    // Time gap with the leader's acceleration estimated from radar (dCACC): the smallest string-stable one with the
    // default gains, a lag of 0.3 s and a radar without delay. With a lag of 0.1 s, 1.15 s suffices. With a radar delay
    // of
    // 0.15 s, 1.56 s (lag 0.3 s) and 1.36 s (lag 0.1 s) are needed.
    double radar_time_gap_s = 1.23;

    bool operator==(const FallbackSettings&) const = default;
};

// Following with the messages of the leader and of the platoon leader: the law of Rajamani 2000, with the values that
// Plexe uses.
struct PlatoonLawSettings {
    double leader_weight = 0.5;  // C1: weight of the platoon leader against the leader
    double damping = 1.0;        // xi
    double bandwidth_1ps = 0.2;  // omega_n

    bool operator==(const PlatoonLawSettings&) const = default;
};

// Platoons of vehicles with a constant distance.
struct PlatoonSettings {
    // Largest number of vehicles: a number, "none", or "by_stability" (v2v/platoon_length.h).
    std::string max_vehicles = "none";
    // Time gap of the leader of a mini-platoon: that of the policy CTG-Ref, the mean of real drivers.
    double time_gap_s = 0.87;

    bool operator==(const PlatoonSettings&) const = default;
};

// The default channel delivers each message after the constant delay. A vehicle then sends in every step.
struct V2vSettings {
    std::string channel = "ideal";  // name of a V2vChannel (v2v/channel.h)
    double loss = 0.1;              // bernoulli, gilbert: share of lost messages
    double burst_messages = 4.0;    // gilbert: mean number of messages from the begin of a loss to its end
    DeliverySettings delivery;      // delivery_over_distance
    // Time from one message of a vehicle to its next one. 0: 0.1 s, the rate of the messages CAM and BSM. Exception: in
    // the channel `ideal`, 0 means every step.
    double interval_s = 0.0;
    std::string jitter_form = "uniform";   // distribution of the random part of the delay
    double jitter_s = 0.0;                 // uniform: largest random part of the delay; exponential: its mean
    double range_m = 500.0;                // messages do not reach further than this
    std::string topology = "predecessor";  // vehicles whose messages a follower uses
    PlatoonLawSettings platoon_law;        // topology predecessor_and_leader
    FallbackSettings fallback;

    bool operator==(const V2vSettings&) const = default;
};

}  // namespace stopline

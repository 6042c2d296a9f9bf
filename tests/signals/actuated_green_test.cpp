// Tests that the mean green of the controllers `actuated` and `dual_ring` follows a closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "signals/ring_junction.h"

namespace stopline {
namespace {

// The mean green of a phase with Poisson arrivals at a point queue. The other phase has a constant length, so the red
// of the first phase is constant, too. The extension after the queue is that of the Highway Capacity Manual, sixth
// edition, chapter 31, section 2 (actuated phase duration): the time to the first gap of a Poisson process that is
// longer than e.
struct PointQueue {
    double flow_1ps;
    double headway_s;
    double lost_s;
    double gap_s;
    double min_green_s;
    double red_s;

    // Time from an arrival to the end of the first gap of length e between Poisson arrivals.
    double extension_s() const { return (std::exp(flow_1ps * gap_s) - 1.0) / flow_1ps; }
    double mean_green_s() const {
        const double empty = std::exp(-flow_1ps * red_s);
        // Green ends after its minimum unless a vehicle arrives within it.
        const double none_s = (1.0 - std::exp(-flow_1ps * min_green_s)) * (1.0 / flow_1ps + extension_s());
        // The queue and the vehicles that join it clear as a busy period.
        const double waiting = flow_1ps * red_s / (1.0 - empty);
        const double clearing_s = (lost_s + waiting * headway_s) / (1.0 - flow_1ps * headway_s);
        return empty * none_s + (1.0 - empty) * (clearing_s + extension_s());
    }
};

// Returns the mean green of the first movement, s, in a simulation of its point queue.
double simulated_green_s(const SignalSettings& settings, const std::vector<std::string>& movements,
                         const PointQueue& queue, std::uint64_t seed) {
    Junction junction(settings, movements);
    Random random(seed);
    double next_arrival_s = 0.0;
    double next_departure_s = 0.0;
    int waiting = 0;
    int greens = 0;
    std::int64_t green_ticks = 0;
    const auto is_green = [&] { return junction.state().lights[0] == Light::green; };
    while (greens < 5'000) {
        const double now_s = static_cast<double>(junction.tick() + 1) * kStep_s;
        bool passes = false;
        while (next_arrival_s <= now_s) {
            next_arrival_s -= std::log(1.0 - uniform(random, 0.0, 1.0)) / queue.flow_1ps;
            if (is_green() && waiting == 0) {
                passes = true;
            } else {
                ++waiting;
            }
        }
        if (is_green() && waiting > 0 && now_s >= next_departure_s - 1e-9) {
            --waiting;
            passes = true;
            next_departure_s += queue.headway_s;
        }
        junction.occupy(junction.stop_detector(0), passes || waiting > 0);
        const bool was_green = is_green();
        junction.step();
        if (!was_green && is_green()) {
            ++greens;
            next_departure_s = static_cast<double>(junction.tick()) * kStep_s + queue.lost_s + queue.headway_s;
        }
        green_ticks += is_green() && greens > 0 ? 1 : 0;
    }
    return static_cast<double>(green_ticks) * kStep_s / (greens - 1);
}

PointQueue queue_of(double flow_veh_h, double other_green_s) {
    return {flow_veh_h / 3600.0, 2.0, 2.0, 3.0, 2.0, 5.0 + other_green_s};
}

PhaseSettings street_of(const PointQueue& queue) {
    PhaseSettings street = phase_of({"west_straight"}, queue.min_green_s, 1000.0, "minimum");
    street.gap_s = queue.gap_s;
    return street;
}

TEST(Actuated, MeanGreenFollowsTheClosedFormForPoissonArrivals) {
    constexpr double kPedestrians_s = 20.0;
    for (const double flow_veh_h : {100.0, 200.0, 300.0, 450.0}) {
        const PointQueue queue = queue_of(flow_veh_h, kPedestrians_s);
        SignalSettings settings;
        settings.first_green_s = 1.0;
        PhaseSettings pedestrians = phase_of({}, 1.0, kPedestrians_s, "minimum");
        pedestrians.yellow_s = pedestrians.all_red_s = 0.0;
        settings.phases = {street_of(queue), pedestrians};
        const double mean_s =
            simulated_green_s(settings, {"west_straight"}, queue, static_cast<std::uint64_t>(flow_veh_h));
        RecordProperty("mean_green_s_" + std::to_string(static_cast<int>(flow_veh_h)), std::to_string(mean_s));
        EXPECT_NEAR(mean_s, queue.mean_green_s(), 0.04 * queue.mean_green_s()) << flow_veh_h << " veh/h";
    }
}

// The cross street has its maximum green in each cycle, 15 s with 3 s of yellow and 2 s of red.
TEST(DualRing, MeanGreenFollowsTheClosedFormForPoissonArrivals) {
    for (const double flow_veh_h : {100.0, 300.0, 450.0}) {
        const PointQueue queue = queue_of(flow_veh_h, 20.0);
        SignalSettings settings;
        settings.controller = "dual_ring";
        settings.first_green_s = 1.0;
        PhaseSettings cross = phase_of({"south_straight"}, 5.0, 15.0, "maximum");
        cross.barrier = 2;
        settings.phases = {street_of(queue), cross};
        const double mean_s = simulated_green_s(settings, {"west_straight", "south_straight"}, queue,
                                                static_cast<std::uint64_t>(flow_veh_h));
        RecordProperty("mean_green_s_" + std::to_string(static_cast<int>(flow_veh_h)), std::to_string(mean_s));
        EXPECT_NEAR(mean_s, queue.mean_green_s(), 0.04 * queue.mean_green_s()) << flow_veh_h << " veh/h";
    }
}

}  // namespace
}  // namespace stopline

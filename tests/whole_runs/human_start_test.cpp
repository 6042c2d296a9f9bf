// The start of a queue of human drivers beside public data. The parameters of the drivers come from the literature and are
// not fitted to these data.
//
// Data:
//   start wave          6.8 m/s, from headways and accelerations of cars with combustion engines that start at a signal
//                       (Salles, Kaufmann, Reuss 2020, and issue 7832 of SUMO). Start-up delays of one vehicle to the
//                       next, measured in public tracks: 0.82 s in Naples, 1.01 s in Stuttgart (n = 23 and 8).
//   first headways      3.8 s, 3.1 s, 2.7 s and 2.4 s at the stop line (Greenshields, Schapiro, Ericksen 1947, "Traffic
//                       performance at urban street intersections"; the first one is from the start of green)
//   discharge           24, 24 and 22 vehicles a lane in 70 s of green (issue 17830 of SUMO)
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

constexpr double kGreen_s = 5.0;
constexpr double kGreenTime_s = 70.0;
constexpr int kQueue = 60;

struct QueueStart {
    double wave_mps = 0.0;               // speed of the start wave between the 5th and the 20th vehicle
    std::array<double, 4> headways_s{};  // at the stop line; the first one is from the start of green
    int passed = 0;                      // vehicles that pass the stop line within 70 s of green
};

QueueStart start_of(const std::string& policy, const std::vector<std::string>& overrides, double step_s) {
    TrackPlan plan;
    plan.policy = policy;
    plan.length_m = 600.0;
    plan.exit_m = 1500.0;
    plan.green_from_s = kGreen_s;
    plan.overrides = overrides;
    plan.step_s = step_s;
    Track track(plan);
    track.place_platoon(0, plan.length_m - track.model().drivers[0].tables.stop.margin_m, 0.0, kQueue - 1);
    const double spacing_m = track.vehicle(0, 0).position_m - track.vehicle(0, 1).position_m;
    std::vector<double> start_s(kQueue, 0.0);
    std::vector<double> passed_s;
    while (track.time_s() < kGreen_s + kGreenTime_s) {
        track.step();
        for (int k = 0; k < track.count(0); ++k) {
            const VehicleView vehicle = track.vehicle(0, k);
            if (vehicle.speed_mps > 0.1 && start_s[at(vehicle.id)] == 0.0) start_s[at(vehicle.id)] = track.time_s();
        }
        while (static_cast<int>(passed_s.size()) < kQueue - track.count(0)) passed_s.push_back(track.time_s());
    }
    QueueStart result;
    result.wave_mps = 15.0 * spacing_m / (start_s[19] - start_s[4]);
    for (std::size_t k = 0; k < 4; ++k) result.headways_s[k] = passed_s[k] - (k == 0 ? kGreen_s : passed_s[k - 1]);
    result.passed = static_cast<int>(passed_s.size());
    return result;
}

TEST(HumanStart, Prints) {
    for (const char* const policy : {"HUMAN", "CTG-Ref", "CDG"}) {
        for (const bool meso : {false, true}) {
            const QueueStart s = start_of(
                policy, meso ? std::vector<std::string>{"fidelity=meso", "meso=fitted"} : std::vector<std::string>{},
                0.01);
            printf("%s %s: wave %.2f m/s, headways %.2f %.2f %.2f %.2f s, passed %d\n", policy, meso ? "meso" : "full",
                   s.wave_mps, s.headways_s[0], s.headways_s[1], s.headways_s[2], s.headways_s[3], s.passed);
        }
    }
}

}  // namespace
}  // namespace stopline

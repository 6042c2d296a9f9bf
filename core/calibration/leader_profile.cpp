#include "calibration/leader_profile.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/units.h"
#include "calibration/startup.h"

namespace stopline {

namespace {

constexpr int kBins = 48;
constexpr double kBin_mps = 1.25 * kMpsPerKmh;  // width of a bin; the bins reach up to 60 km/h
constexpr double kStep_s = 0.01;                // step of the simulation and interval between samples
constexpr double kLast_s = 120.0;

// Returns the scenario of a single lane with one signal, and with a speed limit so high that it does not limit the
// acceleration. On roads with a limit above profile_limit_mps, drivers also use a share of the engine power. Here
// profile_limit_mps is as high as the speed limit, so that only the acceleration curve of the driver determines the
// start. In the mesoscale mode, Model::power_profile adds the engine power on fast roads.
Scenario straight_road_scenario(const Scenario& scenario) {
    Scenario road = scenario;
    road.fidelity = "full";
    road.step_s = kStep_s;
    road.network = {};
    road.network.kind = "approach";
    road.network.approach.speed_limit_mps = 2.0 * kBins * kBin_mps;
    road.driver.free_drive.profile_limit_mps = road.network.approach.speed_limit_mps;
    road.demand = {};
    road.demand.kind = "queue";
    road.signal = {};
    road.rules = {};
    road.measure = {};
    return road;
}

}  // namespace

void measure_leader_profile(const Scenario& scenario, MesoSettings& settings) {
    std::vector<double> times_s;
    for (int k = 0; k * kStep_s <= kLast_s; ++k) times_s.push_back(k * kStep_s);
    const StartupRun start = simulate_start(straight_road_scenario(scenario), times_s);
    settings.leader_profile_mps.clear();
    settings.leader_profile_mps2.clear();
    std::size_t from = 0;  // first sample at or above the bin's lower end; the first bin starts when the vehicle moves
    for (int bin = 0; bin < kBins; ++bin) {
        const double upper_mps = (bin + 1) * kBin_mps;
        std::size_t to = from;
        while (to + 1 < start.speed_mps.size() && start.speed_mps[to] < upper_mps) ++to;
        if (start.speed_mps[to] < upper_mps) break;  // the vehicle never reaches this bin's upper end
        if (to == from) continue;
        settings.leader_profile_mps.push_back((bin + 0.5) * kBin_mps);
        settings.leader_profile_mps2.push_back((start.speed_mps[to] - start.speed_mps[from]) /
                                               (start.time_s[to] - start.time_s[from]));
        from = to;
    }
}

}  // namespace stopline

// Every named metric of an intersection, in sweeps and in the table of stopline-run, has the right value.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "base/io/csv.h"
#include "runs/intersection/intersection.h"
#include "runs/run_metrics.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

// Returns a mesoscale scenario with turns and one population.
Scenario short_intersection() {
    Scenario scenario = load_scenario(STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml",
                                      {"fidelity=meso", "demand.left=20 %", "demand.right=5 %", "measure.cycles=2"});
    scenario.populations = {scenario.populations[0]};
    return scenario;
}

// Returns the expected value of each column. All values differ, so that a mix-up of names is found.
std::map<std::string, double> expected_values(const IntersectionResult& f) {
    return {{"throughput_veh_h", f.throughput_veh_h},
            {"travel_time_94m_s", f.zones[0].travel_time_s},
            {"travel_time_40m_s", f.zones[1].travel_time_s},
            {"delay_94m_s", f.delay_s[0]},
            {"delay_40m_s", f.delay_s[1]},
            {"density_94m_percent", 100.0 * f.zones[0].occupied},
            {"density_40m_percent", 100.0 * f.zones[1].occupied},
            {"density_network_percent", 100.0 * f.occupied},
            {"vehicles_per_green", f.discharge.vehicles_per_green},
            {"startup_lost_time_s", f.discharge.startup_lost_time_s},
            {"longest_queue_m", f.longest_queue_m},
            {"turned_right_percent", 100.0 * f.right_share},
            {"turned_left_percent", 100.0 * f.left_share},
            {"longest_in_junction_s", f.longest_in_junction_s}};
}

// At a speed limit of 10 km/h, a vehicle is inside the junction of 60 m for more than two cycles of 12 s. A deadlock is
// a longer stay: two cycles plus the time of an unobstructed crossing.
TEST(IntersectionMetrics, SlowlyDrivingVehiclesAreNoDeadlock) {
    const Scenario scenario = parse_scenario(
        "network: {kind: intersection, intersection: {lanes: [{movements: straight}], radius: 30 m, speed_limit: 10 km/h}}\n"
        "signal: {first_green: 1 s, green: 3 s, yellow: 2 s, all_red: 1 s}\n"
        "demand: {kind: saturated, start: queued}\n"
        "measure: {warmup_cycles: 0, cycles: 3}\n"
        "populations: [CDG]\n",
        "slow.yaml");
    const IntersectionResult result = run_intersection(scenario, 0);
    EXPECT_GT(result.longest_in_junction_s, 24.0);
    EXPECT_EQ(result.violations.deadlocks, 0);
}

TEST(IntersectionMetrics, HaveTheValuesOfTheirNames) {
    const Scenario scenario = short_intersection();
    const IntersectionResult result = run_intersection(scenario, 0);
    ASSERT_GT(result.left_share, 2.0 * result.right_share);
    std::map<std::string, std::string> metrics;
    for (const RunMetric& metric : run_metrics(scenario, 0)) metrics[metric.column] = metric.value;
    for (const auto& [name, value] : expected_values(result)) {
        ASSERT_TRUE(metrics.contains(name)) << name;
        EXPECT_NEAR(std::stod(metrics[name]), value, 0.0051) << name;
    }
    EXPECT_NEAR(std::stod(metrics["saturation_headway_s"]), result.discharge.saturation_headway_s, 1e-5);
    EXPECT_NEAR(std::stod(metrics["queue_veh"]), result.queue_veh, 1e-5);
    EXPECT_NEAR(std::stod(metrics["vehicles_present"]), result.vehicles_present, 1e-5);
    EXPECT_EQ(metrics["gaps_accepted"], std::to_string(result.gaps_accepted));
    EXPECT_EQ(metrics["vehicles_exited"], std::to_string(result.exited));
}

TEST(IntersectionTable, HasTheValuesOfItsColumns) {
    IntersectionReport report;
    report.scenario = short_intersection();
    report.populations = {run_intersection(report.scenario, 0)};
    report.populations[0].violations = {1, 2, 3, 4, 5};  // made-up counts, because the run has no violations
    const CsvTable table = parse_csv(intersection_csv(report), "table");
    ASSERT_EQ(table.rows.size(), 1u);
    const auto cell = [&](const std::string& name) { return std::stod(table.rows[0][table.column(name)]); };
    for (const auto& [name, value] : expected_values(report.populations[0])) {
        EXPECT_NEAR(cell(name), value, name == "throughput_veh_h" ? 0.051 : 0.0051) << name;
    }
    EXPECT_NEAR(cell("saturation_flow_veh_h"), report.populations[0].discharge.saturation_flow_veh_h, 0.051);
    EXPECT_NEAR(cell("queue_veh"), report.populations[0].queue_veh, 0.0051);
    EXPECT_NEAR(cell("vehicles_present"), report.populations[0].vehicles_present, 0.0051);
    EXPECT_EQ(cell("overlaps"), 1);
    EXPECT_EQ(cell("conflicts"), 2);
    EXPECT_EQ(cell("red_entries"), 3);
    EXPECT_EQ(cell("forced_red_entries"), 4);
    EXPECT_EQ(cell("lost_vehicles"), 5);
}

}  // namespace
}  // namespace stopline

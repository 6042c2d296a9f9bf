// All ways of running a scenario report departure delays.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "runs/run_kind.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

// Returns the value of a metric of the first population; "" if there is no such metric.
std::string metric_of(const Scenario& scenario, const std::string& column) {
    for (const RunMetric& metric : run_kind(scenario).metrics(scenario, 0, [] { return true; })) {
        if (metric.column == column) return metric.value;
    }
    return "";
}

TEST(DepartureDelay, IsAMetricOfAllWaysOfRunning) {
    for (
        const std::string network :
        {"network: {approach: {length: 200 m}}, signal: {first_green: 30 s, green: 20 s, cycle: 60 s}, duration: 400 s, "
         "measure: {green: [10 s]",
         "network: {kind: intersection}, signal: {first_green: 1 s, green: 10 s}, duration: 400 s, measure: {warmup_cycles: "
         "1",
         "network: {kind: grid, grid: {columns: 2, rows: 1}}, signal: {first_green: 1 s, green: 10 s}, duration: 400 s, "
         "measure: {window: 300 s"}) {
        const Scenario scenario = parse_scenario("{fidelity: meso, populations: [CTG-Ref], " + std::string(network) +
                                                     ", departure_delay: on}, demand: {kind: rate, inflow: 2400 veh/h, "
                                                     "arrivals: poisson}}",
                                                 "test.yaml");
        EXPECT_GT(std::stod(metric_of(scenario, "departure_delay_mean_s")), 1.0) << network;
        EXPECT_GT(std::stod(metric_of(scenario, "departure_delay_max_s")), 10.0) << network;
        EXPECT_GT(std::stod(metric_of(scenario, "backlog")), 10.0) << network;
        Scenario off = scenario;
        off.measure.departure_delay = "off";
        EXPECT_EQ(metric_of(off, "departure_delay_mean_s"), "");
    }
}

}  // namespace
}  // namespace stopline

// The result columns of a scenario are known before it runs.
#include "runs/run_metrics.h"

#include <gtest/gtest.h>

#include "runs/short_scenario.h"

namespace stopline {
namespace {

std::vector<std::string> columns_of_a_run(const Scenario& scenario) {
    std::vector<std::string> columns;
    for (const RunMetric& metric : run_metrics(scenario, 0)) columns.push_back(metric.column);
    return columns;
}

TEST(ResultColumns, AgreeWithTheColumnsOfARun) {
    const auto shipped = [](const char* file, std::vector<std::string> overrides) {
        overrides.insert(overrides.end(), {"populations=[CDG]", "measure.baseline=CDG"});
        return load_scenario(std::string(STOPLINE_SOURCE_DIR "/scenarios/") + file, overrides);
    };
    for (const Scenario& scenario :
         {short_scenario(), shipped("intersection.yaml", {"measure.cycles=1", "measure.warmup_cycles=0"}),
          shipped("grid.yaml", {"duration=120 s", "measure.window=60 s"}),
          shipped("berlin.yaml", {"duration=120 s", "measure.window=60 s"})}) {
        EXPECT_EQ(result_columns(scenario), columns_of_a_run(scenario)) << scenario.name;
    }
}

}  // namespace
}  // namespace stopline

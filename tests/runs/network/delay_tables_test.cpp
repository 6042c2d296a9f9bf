// lane_delays.csv adds up the episodes of delays.csv.
#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "runs/network/network.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

std::vector<std::vector<std::string>> rows_of(const std::string& csv) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream cells(line);
        rows.emplace_back();
        for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
    }
    rows.erase(rows.begin());  // the header
    return rows;
}

TEST(DelayTables, LaneDelaysAreTheSumsOfTheEpisodes) {
    const Scenario scenario = load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                                            {"network.grid.columns=2", "network.grid.rows=2", "duration=600 s",
                                             "measure.window=300 s", "demand.left=20 %"});
    const NetworkReport report = run_networks(scenario, {});
    struct Sum {
        int episodes = 0;
        double delay_s = 0.0;
    };
    std::map<std::string, Sum> sums;  // [population, lane and cause]
    for (const std::vector<std::string>& row : rows_of(delays_csv(report))) {
        Sum& sum = sums[row[0] + " " + row[2] + " " + row[1]];
        ++sum.episodes;
        sum.delay_s += std::stod(row.back());
    }
    ASSERT_GT(sums.size(), 10U) << "too few lanes with delays";
    std::size_t several = 0;
    const std::vector<std::vector<std::string>> rows = rows_of(lane_delays_csv(report));
    EXPECT_EQ(rows.size(), sums.size());
    for (const std::vector<std::string>& row : rows) {
        const Sum& sum = sums[row[0] + " " + row[1] + " " + row[2]];
        EXPECT_EQ(std::stoi(row[3]), sum.episodes);
        EXPECT_NEAR(std::stod(row[4]), sum.delay_s, 0.06 * sum.episodes);  // rounding to 0.1 s
        several += sum.episodes > 1 ? 1U : 0U;
    }
    EXPECT_GT(several, 0U) << "no lane has several episodes";
}

}  // namespace
}  // namespace stopline

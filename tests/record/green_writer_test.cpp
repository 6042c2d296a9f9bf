// Tests of the table of greens: it agrees with the programme of fixed-time signals, and with the limits of actuated
// ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "base/io/csv.h"
#include "record/green_writer.h"
#include "scenario/build_model.h"
#include "scenario/scenario_text.h"
#include "sim/step/simulation.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

constexpr double kDuration_s = 400.0;
constexpr double kStep_s = 0.1;
constexpr const char* kStraightLanes = "west_in_1 west_in_2 east_in_1 east_in_2";
constexpr double kCycle_s = 78.0;  // of the programme in phases.yaml

// One row of the table. A time is -1000 if its cell is empty.
struct Green {
    std::string lanes;
    double start_s, end_s, green_s, red_before_s;
};

double number(const std::string& cell) { return cell.empty() ? -1000.0 : std::stod(cell); }

// Runs a scenario, and returns the greens of each signal group. Expects that all belong to signal 0.
std::map<std::string, std::vector<Green>> greens_in(const Scenario& scenario) {
    const std::string file = ::testing::TempDir() + "greens.csv";
    const Model model = build_model(scenario, 0);
    const auto writer = make_green_writer(file, "CTG-Ref", model);
    Simulation simulation(model);
    while (simulation.time_s() < kDuration_s - 0.5 * kStep_s) {
        writer->observe(simulation.state());
        simulation.step();
    }
    writer->observe(simulation.state());
    writer->finish();
    std::ifstream stream(file);
    const CsvTable table = parse_csv(std::string(std::istreambuf_iterator<char>(stream), {}), file);
    std::map<std::string, std::vector<Green>> greens;
    for (const std::vector<std::string>& row : table.rows) {
        EXPECT_EQ(row.at(0), "CTG-Ref");
        EXPECT_EQ(row.at(1), "0");
        greens[row.at(2)].push_back(
            {row.at(3), number(row.at(4)), number(row.at(5)), number(row.at(6)), number(row.at(7))});
    }
    return greens;
}

// The same for the scenario phases.yaml.
std::map<std::string, std::vector<Green>> greens_of(const std::vector<std::string>& settings) {
    std::vector<std::string> all{"populations=[CTG-Ref]"};
    all.insert(all.end(), settings.begin(), settings.end());
    return greens_in(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/phases.yaml", all));
}

// Lanes without a signal belong to a group with constant green. This group is no signal.
TEST(GreenWriter, LeavesOutLanesWithoutSignal) {
    const testing::SumoFiles files;
    files.write("my.net.xml", testing::opposing_lefts_net());
    files.write("my.rou.xml",
                R"(<routes><vType id="x"/><trip id="w" type="x" depart="30" from="w" to="to_n"/></routes>)");
    const Scenario scenario = parse_scenario(
        "duration: 400 s\nnetwork: {kind: sumo, net: ./my.net.xml, routes: [./my.rou.xml]}\npopulations: [CTG-Ref]\n",
        "my.yaml", {}, files.folder());
    EXPECT_TRUE(greens_in(scenario).empty());
}

TEST(GreenWriter, ListsTheGreensOfTheProgramme) {
    const auto greens = greens_of({});
    int straight_groups = 0;
    for (const auto& [group, rows] : greens) {
        SCOPED_TRACE("group " + group);
        for (std::size_t k = 0; k < rows.size(); ++k) {
            SCOPED_TRACE("green " + std::to_string(k));
            EXPECT_FALSE(rows[k].lanes.empty());
            if (rows[k].end_s < 0.0) {
                EXPECT_EQ(k + 1, rows.size()) << "only the last green can be without an end";
                continue;
            }
            EXPECT_NEAR(rows[k].end_s - rows[k].start_s, rows[k].green_s, 1e-9);
            if (k == 0) continue;
            EXPECT_NEAR(rows[k].red_before_s, rows[k].start_s - rows[k - 1].end_s, 1e-9);
            EXPECT_NEAR(rows[k].start_s - rows[k - 1].start_s, kCycle_s, 1e-9);
        }
        EXPECT_LT(rows.front().red_before_s, 0.0) << "no green before the first one";
        if (rows.front().lanes != kStraightLanes) continue;
        ++straight_groups;
        EXPECT_NEAR(rows.front().start_s, 1.0 + 8.0 + 3.0 + 1.0, 1e-9);
        EXPECT_NEAR(rows.front().green_s, 24.0, 1e-9);
    }
    EXPECT_EQ(straight_groups, 1);
}

TEST(GreenWriter, ShowsHowActuatedGreensVary) {
    const auto greens = greens_of({"signal.controller=actuated", "signal.phases[2].recall=minimum",
                                   "demand.inflow=400 veh/h", "signal.phases[1].min_green=6 s"});
    std::vector<double> lengths_s;
    for (const auto& [group, rows] : greens) {
        for (const Green& green : rows) {
            if (green.lanes == kStraightLanes && green.green_s > 0.0) lengths_s.push_back(green.green_s);
        }
    }
    ASSERT_GT(lengths_s.size(), 3U);
    const auto [shortest, longest] = std::minmax_element(lengths_s.begin(), lengths_s.end());
    EXPECT_GE(*shortest, 6.0 - 1e-9) << "the minimum green";
    EXPECT_GT(*longest, *shortest + 1.0) << "greens follow the traffic";
}

}  // namespace
}  // namespace stopline

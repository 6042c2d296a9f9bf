// Tests of result files of an imported network: each position must lie on the lane that stands beside it in the file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "record/sumo_files.h"
#include "record/trajectory_writer.h"
#include "runs/network/network_run.h"
#include "scenario/load_scenario.h"
#include "sumo_import/sumo_net.h"
#include "sumo_import/sumo_xml.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

using testing::SumoFiles;

// A network file and vehicles for it.
struct Case {
    std::string name;
    std::string net;
    std::string routes;
    std::vector<std::string> expected_lanes;  // lanes that vehicles must use during the run
};

void PrintTo(const Case& test, std::ostream* stream) { *stream << test.name; }  // NOLINT: a name of GoogleTest

// A row of floating car data.
struct Row {
    std::string lane;
    double position_m;
    Point front;
};

class NamedPlaces : public ::testing::TestWithParam<Case> {
protected:
    void SetUp() override {
        files_.write("my.net.xml", GetParam().net);
        files_.write("my.rou.xml", "<routes>" + GetParam().routes + "</routes>");
        model_ =
            network_model(parse_scenario("fidelity: meso\nduration: 60 s\nnetwork: {kind: sumo, net: ./my.net.xml, "
                                         "routes: [./my.rou.xml]}\npopulations: [CDG]\nmeasure: {window: 60 s}\n",
                                         "my.yaml", {}, files_.folder()),
                          0);
        net_ = read_sumo_net(files_.folder() / "my.net.xml");
    }

    std::filesystem::path run(const std::string& name, const auto& make_writer) {
        const std::filesystem::path file = files_.folder() / name;
        const std::unique_ptr<RunWriter> writer = make_writer(file);
        Simulation simulation(model_);
        for (writer->observe(simulation.state()); simulation.time_s() < 60.0; writer->observe(simulation.state()))
            simulation.step();
        writer->finish();
        return file;
    }
    std::filesystem::path run_fcd(const std::string& name) {
        return run(name, [&](const auto& file) { return make_fcd_writer(file, {0.1, 0.0, 1e9}, model_); });
    }
    const SumoLane& lane_in_file(const std::string& id) const {
        const auto found = net_.lane(id);
        EXPECT_TRUE(found) << id;
        static const SumoLane none;
        return found ? net_.edges[static_cast<std::size_t>(found->first)].lanes[static_cast<std::size_t>(found->second)]
                     : none;
    }

    SumoFiles files_;
    Model model_;
    SumoNet net_;
};

std::vector<Row> rows_of(const std::filesystem::path& file) {
    std::vector<Row> rows;
    const SumoXml xml(file, {"fcd-export"});
    for (const pugi::xml_node step : xml.root()) {
        for (const pugi::xml_node v : step) {
            rows.push_back({xml.text(v, "lane"), xml.number(v, "pos"), {xml.number(v, "x"), xml.number(v, "y")}});
        }
    }
    return rows;
}

TEST_P(NamedPlaces, HoldPositionsInFcd) {
    constexpr double kRounding_m = 0.011;
    // Points of the import may lie this far from the points in the file: the import joins several shapes of the file
    // into one, whose length can differ from the length of the lane, and draws U-turns wider than the file does.
    constexpr double kStretch_m = 1.2;
    std::vector<std::string> seen;
    for (const Row& row : rows_of(run_fcd("fcd.xml"))) {
        const SumoLane& lane = lane_in_file(row.lane);
        EXPECT_LE(row.position_m, lane.length_m + kRounding_m) << row.lane;
        EXPECT_GE(row.position_m, 0.0) << row.lane;
        const Point expected = pose_at(lane.shape, row.position_m * length_m(lane.shape) / lane.length_m).point;
        EXPECT_LT(std::hypot(row.front.x_m - expected.x_m, row.front.y_m - expected.y_m), kStretch_m)
            << row.lane << " " << row.position_m;
        seen.push_back(row.lane);
    }
    for (const std::string& lane : GetParam().expected_lanes) {
        EXPECT_NE(std::find(seen.begin(), seen.end(), lane), seen.end()) << lane << " is never used";
    }
}

TEST_P(NamedPlaces, HoldPositionsInTripinfo) {
    const std::filesystem::path file =
        run("trips.xml", [&](const auto& path) { return make_tripinfo_writer(path, model_); });
    const SumoXml xml(file, {"tripinfos"});
    int trips = 0;
    for (const pugi::xml_node trip : xml.root()) {
        for (const auto& [lane, position] : {std::pair{"departLane", "departPos"}, {"arrivalLane", "arrivalPos"}}) {
            EXPECT_LE(xml.number(trip, position), lane_in_file(xml.text(trip, lane)).length_m + 0.011) << lane;
        }
        ++trips;
    }
    EXPECT_GT(trips, 0);
}

TEST_P(NamedPlaces, AreTheSameInTrajectories) {
    const std::vector<Row> fcd = rows_of(run_fcd("fcd.xml"));
    const std::filesystem::path file = run("trajectories.csv", [&](const auto& path) {
        return make_trajectory_writer(path, {0.1, 0.0, 1e9}, "CDG", model_);
    });
    std::ifstream stream(file);
    std::string line;
    std::getline(stream, line);
    std::size_t k = 0;
    for (; std::getline(stream, line); ++k) {
        ASSERT_LT(k, fcd.size());
        EXPECT_NE(line.find("," + fcd[k].lane + ","), std::string::npos) << line << " instead of " << fcd[k].lane;
    }
    EXPECT_EQ(k, fcd.size());
}

TEST_P(NamedPlaces, CompressedFileHasTheSameText) {
    const SumoXml plain(run_fcd("fcd.xml"), {"fcd-export"});
    const SumoXml compressed(run_fcd("fcd.xml.gz"), {"fcd-export"});  // SumoXml also reads compressed files
    EXPECT_EQ(plain.hash(), compressed.hash());
    EXPECT_LT(4 * std::filesystem::file_size(files_.folder() / "fcd.xml.gz"),
              std::filesystem::file_size(files_.folder() / "fcd.xml"));
    std::ifstream stream(files_.folder() / "fcd.xml.gz", std::ios::binary);
    EXPECT_EQ(stream.get(), 0x1f);
    EXPECT_EQ(stream.get(), 0x8b);
}

std::string read_data(const std::string& name) {
    std::ifstream stream(std::filesystem::path(STOPLINE_TEST_DATA_DIR) / name);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::string flow(const std::string& from, const std::string& to) {
    return "<flow id=\"" + from + to + "\" from=\"" + from + "\" to=\"" + to +
           "\" begin=\"0\" end=\"30\" period=\"7\" departSpeed=\"max\" departLane=\"random\"/>";
}

// Networks in which the lanes of the import differ from the lanes of the file: a turn over two internal lanes, short
// edges that the import joins to the edges before them, a U-turn, and connections that share a stretch.
INSTANTIATE_TEST_SUITE_P(
    Networks, NamedPlaces,
    ::testing::Values(
        Case{"Chain",
             read_data("left_turns.net.xml"),
             flow("ni", "eo") + flow("si", "wo") + flow("ni", "so"),
             {"ni_0", ":c_2_0", ":c_12_0", "eo_0", ":c_1_0"}},
        Case{"JoinedEdge", testing::lane_drop_net(), flow("a", "c"), {"a_0", ":J_0_0", "s_0", ":K_0_0", "c_0"}},
        Case{"TwoBranches",
             testing::roundabout_net(),
             flow("b", "c") + flow("b", "x"),
             {"b_0", ":J_0_0", ":J_1_0", "s_0", "c_0", "x_0"}},
        Case{"UTurn", testing::turnaround_net(), flow("a", "b") + flow("a", "c"), {":J_1_0", ":J_2_0"}},
        Case{"Crossing",
             testing::crossing_net(),
             flow("w_in", "e_out") + flow("w_in", "n_out"),
             {"w_in_0", "w_in_1", ":J_1_0"}}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace stopline

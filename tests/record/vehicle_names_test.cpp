// Tests of the names of vehicles: the tables and the --fcd file of a run give a vehicle the same name.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "base/io/csv.h"
#include "record/sumo_files.h"
#include "record/trajectory_writer.h"
#include "runs/run_report.h"
#include "scenario/load_scenario.h"
#include "sim/state/queries/vehicle_names.h"
#include "sumo_import/sumo_xml.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

using testing::SumoFiles;

// The vehicles from the south never get green: the first one starves until it is teleported. The others wait in the
// backlog while vehicles of later trips enter, so the numbers of vehicles differ from those of their trips. The slow
// street to the north fills with vehicles that turn left.
constexpr const char* kFlows =
    R"(<flow id="south, &quot;main&quot; street" from="s_in" to="n_out" begin="0" end="100" number="60"/>
<flow id="l" from="w_in" to="n_out" vehsPerHour="500" end="280" departLane="best" departSpeed="max"/>
<flow id="w" from="w_in" to="e_out" vehsPerHour="700" end="280" departLane="best" departSpeed="max"/>)";
constexpr const char* kPhases =
    R"(<phase duration="20" state="rGGG"/><phase duration="4" state="ryyy"/><phase duration="30" state="rrrr"/>)";

const std::string kFirstFromSouth = "south, \"main\" street.0";

using Row = std::tuple<std::string, std::string, std::string>;  // time, vehicle and lane

CsvTable read_csv(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return parse_csv(std::string(std::istreambuf_iterator<char>(stream), {}), file.string());
}

class VehicleNamesOfARun : public ::testing::Test {
protected:
    void SetUp() override {
        files_.write("my.net.xml", testing::replaced(testing::signal_net(kPhases), R"(disallow="tram" speed="13.89")",
                                                     R"(disallow="tram" speed="0.5")"));
        files_.write("my.rou.xml", std::string("<routes>") + kFlows + "</routes>");
        const Scenario scenario = parse_scenario(
            "fidelity: meso\nduration: 300 s\nnetwork: {kind: sumo, net: ./my.net.xml, routes: [./my.rou.xml]}\n"
            "populations: [CDG]\nrules: {clearing: cooperative, teleport_cycles: 3}\n"
            "measure: {window: 200 s, starvation: 120 s, energy: on}\n",
            "my.yaml", {}, files_.folder());
        std::vector<std::unique_ptr<RunWriter>> writers;
        NetworkOptions options;
        options.observation.look = [&](std::size_t /*population*/, const Simulation& simulation) {
            if (writers.empty()) {
                const Model& model = simulation.model();
                writers.push_back(make_fcd_writer(fcd_file(), {}, model));
                writers.push_back(make_trajectory_writer(trajectory_file(), {}, "CDG", model));
            }
            for (const auto& writer : writers) writer->observe(simulation.state());
        };
        for (auto& [name, text] : result_tables(run_networks(scenario, options))) tables_[name] = parse_csv(text, name);
        for (const auto& writer : writers) writer->finish();
        const SumoXml xml(fcd_file(), {"fcd-export"});
        for (const pugi::xml_node step : xml.root()) {
            for (const pugi::xml_node vehicle : step) {
                fcd_.emplace(fixed(xml.number(step, "time"), 1), xml.text(vehicle, "id"), xml.text(vehicle, "lane"));
                fcd_names_.insert(xml.text(vehicle, "id"));
            }
        }
    }

    std::filesystem::path fcd_file() const { return files_.folder() / "fcd.xml"; }
    std::filesystem::path trajectory_file() const { return files_.folder() / "trajectories.csv"; }

    // Expects that each vehicle in the column `vehicle` is on the lane in the column `lane` at the time in the column
    // `time`. Returns the names of the vehicles.
    std::set<std::string> expect_places_in_fcd(const std::string& name, const char* vehicle, const char* lane,
                                               const char* time) const {
        const CsvTable& table = tables_.at(name);
        std::set<std::string> names;
        for (const std::vector<std::string>& cells : table.rows) {
            const Row row{cells[table.column(time)], cells[table.column(vehicle)], cells[table.column(lane)]};
            if (std::get<1>(row).empty()) continue;  // no blocker
            EXPECT_TRUE(fcd_.contains(row)) << name << ": " << std::get<1>(row) << " at " << std::get<0>(row) << " s";
            names.insert(std::get<1>(row));
        }
        return names;
    }
    // Returns the names in a column of a table.
    std::set<std::string> names_in(const std::string& name, const char* column) const {
        const CsvTable& table = tables_.at(name);
        std::set<std::string> names;
        for (const std::vector<std::string>& cells : table.rows) names.insert(cells[table.column(column)]);
        return names;
    }

    SumoFiles files_;
    std::map<std::string, CsvTable> tables_;  // [file name]
    std::set<Row> fcd_;
    std::set<std::string> fcd_names_;
};

TEST_F(VehicleNamesOfARun, AreTheSameInDelaysAndStarvations) {
    const std::set<std::string> delayed = expect_places_in_fcd("delays.csv", "vehicle", "lane", "from_s");
    EXPECT_GE(delayed.size(), 4U);
    EXPECT_TRUE(delayed.contains(kFirstFromSouth));
    EXPECT_GE(expect_places_in_fcd("delays.csv", "blocker", "blocker_lane", "from_s").size(), 2U);
    EXPECT_EQ(expect_places_in_fcd("starvations.csv", "vehicle", "lane", "to_s"), std::set{kFirstFromSouth});
}

TEST_F(VehicleNamesOfARun, AreTheSameInRules) {
    const CsvTable& rules = tables_.at("rules.csv");
    std::set<std::string> teleported;
    for (const std::vector<std::string>& cells : rules.rows) {
        if (cells[rules.column("rule")] == "teleported") teleported.insert(cells[rules.column("vehicle")]);
    }
    EXPECT_TRUE(teleported.contains(kFirstFromSouth));
    std::set<std::string> names = names_in("rules.csv", "blocker");
    EXPECT_EQ(names.erase(""), 1U);  // teleports have no blocker
    EXPECT_GE(names.size(), 2U);
    names.merge(names_in("rules.csv", "vehicle"));
    for (const std::string& name : names) EXPECT_TRUE(fcd_names_.contains(name)) << name;
}

TEST_F(VehicleNamesOfARun, AreTheSameInEnergy) {
    EXPECT_EQ(names_in("energy.csv", "vehicle"), fcd_names_);
    EXPECT_EQ(tables_.at("energy.csv").rows.size(), fcd_names_.size());
    EXPECT_TRUE(fcd_names_.contains("w.50"));
}

TEST_F(VehicleNamesOfARun, AreTheSameInTrajectories) {
    const CsvTable table = read_csv(trajectory_file());
    for (const std::vector<std::string>& cells : table.rows) {
        const Row row{fixed(std::stod(cells[table.column("time_s")]), 1), cells[table.column("vehicle")],
                      cells[table.column("lane")]};
        ASSERT_TRUE(fcd_.contains(row)) << std::get<1>(row) << " at " << std::get<0>(row) << " s";
    }
    EXPECT_EQ(table.rows.size(), fcd_.size());
}

TEST(VehicleNames, AreNumbersWithoutTrips) {
    EXPECT_EQ(VehicleNames().of(17), "17");
    EXPECT_EQ(VehicleNames().of(-1), "-1");
    const Scenario scenario = load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml", {"duration=60 s"});
    const Model model = network_model(scenario, 0);
    Simulation simulation(model);
    simulation.run_until(20.0);
    ASSERT_GT(simulation.state().records.entered, 5);
    EXPECT_TRUE(simulation.state().insertion.vehicle_trips.empty());
    EXPECT_EQ(VehicleNames(model, simulation.state()).of(5), "5");
}

}  // namespace
}  // namespace stopline

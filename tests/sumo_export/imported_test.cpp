// Tests of the input that SUMO gets for a scenario on an imported network.
#include "sumo_export/imported.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/io/output.h"
#include "record/sumo_files.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "scenario/scenario_text.h"
#include "sumo_export/compare.h"
#include "sumo_export/export.h"
#include "sumo_export/facts.h"
#include "sumo_import/sumo_xml.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

using testing::crossing_net;
using testing::signal_net;
using testing::SumoFiles;
using testing::two_phases;

// Returns a network in which edge a (100 m) leads to s (5 m), which ends at a signal, and s leads to c.
std::string short_edge_net() {
    return R"(<net version="1.20">
<edge id=":J_0" function="internal"><lane id=":J_0_0" index="0" speed="9" length="3" shape="100,0 103,0"/></edge>
<edge id=":K_0" function="internal"><lane id=":K_0_0" index="0" speed="9" length="10" shape="108,0 118,0"/></edge>
<edge id="a" from="A" to="J"><lane id="a_0" index="0" speed="9" length="100" shape="0,0 100,0"/></edge>
<edge id="s" from="J" to="K"><lane id="s_0" index="0" speed="9" length="5" shape="103,0 108,0"/></edge>
<edge id="c" from="K" to="C"><lane id="c_0" index="0" speed="9" length="100" shape="118,0 218,0"/></edge>
<tlLogic id="K" type="static" programID="0" offset="0"><phase duration="30" state="G"/><phase duration="30" state="r"/></tlLogic>
<junction id="J" type="priority" x="100" y="0" incLanes="a_0" intLanes=":J_0_0" shape="0,0 1,1">
<request index="0" response="0" foes="0" cont="0"/></junction>
<junction id="K" type="traffic_light" x="110" y="0" incLanes="s_0" intLanes=":K_0_0" shape="0,0 1,1">
<request index="0" response="0" foes="0" cont="0"/></junction>
<connection from="a" to="s" fromLane="0" toLane="0" via=":J_0_0" dir="s" state="M"/>
<connection from="s" to="c" fromLane="0" toLane="0" via=":K_0_0" tl="K" linkIndex="0" dir="s" state="O"/>
<connection from=":J_0" to="s" fromLane="0" toLane="0" dir="s" state="M"/>
<connection from=":K_0" to="c" fromLane="0" toLane="0" dir="s" state="M"/>
)" + testing::dead_ends("AC") +
           "</net>\n";
}

Scenario scenario_of(const std::string& net, const std::string& routes, const std::string& additional = "",
                     const std::string& further_fields = "rules: {}\n") {
    const SumoFiles files;
    files.write("my.net.xml", net);
    files.write("my.rou.xml", "<routes>\n" + routes + "\n</routes>");
    files.write("my.add.xml", "<additional>\n" + additional + "\n</additional>");
    return parse_scenario(
        "fidelity: meso\nduration: 60 s\n"
        "network: {kind: sumo, net: ./my.net.xml, routes: [./my.rou.xml], additional: [./my.add.xml]}\n"
        "populations: [CTG-Ref]\nmeasure: {window: 60 s}\n" +
            further_fields,
        "my.yaml", {}, files.folder());
}

// Writes the SUMO input of a scenario and reads it back.
class Inputs {
public:
    explicit Inputs(const Scenario& scenario) {
        const Model model = build_model(scenario, 0);
        const SumoNetwork& network = *scenario.network.sumo;
        write_imported_inputs(folder_.path(), model, network, stop_line_names(network), scenario.duration_s);
    }

    // Returns one row for each element of this kind in the file: the given attributes, and the edges of the route if
    // the element has a route.
    std::vector<std::string> rows(const std::string& file, const char* element,
                                  const std::vector<const char*>& attributes) const {
        const SumoXml xml(folder_.path() / file, {"routes", "additional"});
        std::vector<std::string> rows;
        for (const pugi::xml_node node : xml.root().children(element)) {
            std::string row;
            for (const char* const name : attributes) row += (row.empty() ? "" : " ") + xml.text(node, name);
            const std::string edges = node.child("route").attribute("edges").value();
            rows.push_back(edges.empty() ? row : row + ": " + edges);
        }
        return rows;
    }

    std::string configuration() const { return read_file(folder_.path() / "run.sumocfg"); }

private:
    TemporaryFolder folder_;
};

using Rows = std::vector<std::string>;

TEST(ImportedNetwork, KeepsVehiclesAndTheirPlannedTimes) {
    const Inputs inputs(scenario_of(crossing_net(),
                                    R"(<vType id="truck" vClass="truck"/>
<trip id="late &amp; slow" depart="20.25" from="w_in" to="n_out" departLane="1" departPos="-40" departSpeed="3"/>
<vehicle id="v" depart="4" type="truck" departLane="best" departPos="random" departSpeed="max"><route edges="w_in e_out"/></vehicle>
<flow id="f" begin="4" end="6" period="1" from="s_in" to="n_out"/>
<trip id="after" depart="60" from="s_in" to="n_out"/>)"));
    EXPECT_EQ(
        inputs.rows("vehicles.rou.xml", "vehicle", {"id", "type", "depart", "departLane", "departPos", "departSpeed"}),
        (Rows{"v CTG-Ref_7.1m 4.000 best random max: w_in e_out", "f.0 CTG-Ref_5m 4.000 best base avg: s_in n_out",
              "f.1 CTG-Ref_5m 5.000 best base avg: s_in n_out",
              "late & slow CTG-Ref_5m 20.250 1 150.00 3.00: w_in n_out"}));
    const Rows types = inputs.rows("vehicles.rou.xml", "vType", {"id", "length"});
    EXPECT_EQ(types, (Rows{"CTG-Ref_5m 5.0000", "CTG-Ref_7.1m 7.1000"}));
    EXPECT_TRUE(inputs.rows("detectors.add.xml", "instantInductionLoop", {"lane"}).empty());
}

TEST(ImportedNetwork, WritesMesoscaleParametersIntoTypes) {
    const Scenario scenario = scenario_of(crossing_net(), "<trip id=\"a\" depart=\"0\" from=\"s_in\" to=\"n_out\"/>");
    const SumoFollowing type = build_model(scenario, 0).following.at(0).in_sumo();
    EXPECT_EQ(Inputs(scenario).rows("vehicles.rou.xml", "vType", {"accel", "decel", "tau", "sigma"}),
              Rows{fmt::format("{:.4f} {:.4f} {:.4f} {:.4f}", type.acceleration_mps2, type.deceleration_mps2,
                               type.time_gap_s, type.dawdling)});
}

TEST(ImportedNetwork, UsesTheOriginalEdgesForRoutesAndLoops) {
    const Scenario scenario = scenario_of(short_edge_net(), "<trip id=\"a\" depart=\"0\" from=\"a\" to=\"c\"/>");
    const Inputs inputs(scenario);
    EXPECT_EQ(inputs.rows("vehicles.rou.xml", "vehicle", {"id"}), Rows{"a: a s c"});
    EXPECT_EQ(inputs.rows("detectors.add.xml", "instantInductionLoop", {"lane"}), Rows{"s_0"});
    const StopLineNames names = stop_line_names(*scenario.network.sumo);
    EXPECT_EQ(names.stop_line_at_end, (std::map<std::string, std::string>{{"s_0", "a_0"}}));
}

TEST(ImportedNetwork, TakesSignalsFromTheAdditionalFiles) {
    const Inputs inputs(scenario_of(signal_net(two_phases()),
                                    "<trip id=\"a\" depart=\"0\" from=\"s_in\" to=\"n_out\"/>",
                                    R"(<tlLogic id="J" programID="0" offset="7.5"/>)"));
    EXPECT_EQ(inputs.rows("lights.add.xml", "tlLogic", {"id", "type", "programID", "offset"}),
              Rows{"J static stopline 7.500"});
    EXPECT_EQ(inputs.rows("detectors.add.xml", "instantInductionLoop", {"lane"}), (Rows{"s_in_0", "w_in_0", "w_in_1"}));
}

TEST(ImportedNetwork, RefusesProgrammesThatSumoCannotLoad) {
    std::string net = signal_net(two_phases());
    const std::size_t from = net.find("<tlLogic");
    const std::size_t to = net.find("</tlLogic>") + std::string("</tlLogic>").size();
    const std::string programme = net.substr(from, to - from);
    net.erase(from, to - from);
    const Scenario scenario = scenario_of(net, "<trip id=\"a\" depart=\"0\" from=\"s_in\" to=\"n_out\"/>", programme);
    const TemporaryFolder folder;
    const std::string message =
        testing::refusal([&] { compare_with_sumo(scenario, 0, folder.path() / "new", CompareOptions{1}); });
    EXPECT_EQ(message.find("my.add.xml:2: tlLogic 'J' is not in "), 0U) << message;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "new"));
}

TEST(ImportedNetwork, UsesTheOriginalNetworkAndTheRules) {
    const std::string trip = "<trip id=\"a\" depart=\"0\" from=\"s_in\" to=\"n_out\"/>";
    const Scenario plain = scenario_of(signal_net(two_phases()), trip);
    const std::string text = Inputs(plain).configuration();
    EXPECT_TRUE(plain.network.sumo->net.file.is_absolute());
    EXPECT_NE(text.find("<net-file value=\"" + plain.network.sumo->net.file.string() + "\"/>"), std::string::npos);
    EXPECT_NE(text.find("<time-to-teleport value=\"-1\"/>"), std::string::npos);
    EXPECT_NE(text.find("<step-length value=\"0.1\"/>"), std::string::npos);
    const double cycle_s = plain.network.sumo->longest_cycle_s();
    const Scenario with_rules = scenario_of(signal_net(two_phases()), trip, "", "rules: {teleport_cycles: 3}\n");
    EXPECT_NE(Inputs(with_rules).configuration().find(fmt::format("<time-to-teleport value=\"{:g}\"/>", 3.0 * cycle_s)),
              std::string::npos);
}

// The times of steps have rounding errors. They must not appear as a delay of 1e-16 s or of a whole step.
TEST(ImportedNetwork, HasNoDepartureDelayWithoutAQueue) {
    std::string trips;
    for (int k = 0; k < 16; ++k) {
        trips += fmt::format("<trip id=\"{}\" depart=\"{:.2f}\" from=\"s_in\" to=\"n_out\" departSpeed=\"max\"/>\n", k,
                             2.7 * k + (k % 4 == 3 ? 0.05 : 0.0));
    }
    const Scenario scenario = scenario_of(crossing_net(), trips);
    const Model model = build_model(scenario, 0);
    RunFacts facts;
    const SumoFiles files;
    const std::filesystem::path tripinfo = files.folder() / "trips.xml";
    std::vector<std::unique_ptr<RunWriter>> writers;
    writers.push_back(make_facts_writer(model, stop_line_names(*scenario.network.sumo).stop_line_of_lane, facts));
    writers.push_back(make_tripinfo_writer(tripinfo, model));
    Simulation simulation(model);
    run_with_writers(simulation, scenario.duration_s, writers, {});
    ASSERT_GT(facts.trips.size(), 8U);
    for (const RunFacts::Trip& trip : facts.trips) EXPECT_EQ(trip.departure_delay_s, 0.0);
    const SumoXml written(tripinfo, {"tripinfos"});
    for (const pugi::xml_node trip : written.root().children("tripinfo"))
        EXPECT_EQ(written.text(trip, "departDelay"), "0.00") << written.text(trip, "id");
}

TEST(ImportedNetwork, CountsDepartureDelayFromThePlannedDeparture) {
    std::string trips;
    for (int k = 0; k < 60; ++k) {
        trips += fmt::format("<trip id=\"{}\" depart=\"1\" from=\"s_in\" to=\"n_out\" departSpeed=\"max\"/>\n", k);
    }
    const Scenario scenario = scenario_of(crossing_net(), trips);
    const Model model = build_model(scenario, 0);
    RunFacts facts;
    std::vector<std::unique_ptr<RunWriter>> writers;
    writers.push_back(make_facts_writer(model, stop_line_names(*scenario.network.sumo).stop_line_of_lane, facts));
    Simulation simulation(model);
    run_with_writers(simulation, scenario.duration_s, writers, {});
    ASSERT_GT(facts.trips.size(), 3U);
    EXPECT_EQ(facts.trips[0].departure_delay_s, 0.0);
    EXPECT_NEAR(facts.trips[2].departure_delay_s - facts.trips[1].departure_delay_s, facts.trips[1].departure_delay_s,
                1.5);
    EXPECT_GT(facts.trips[2].departure_delay_s, 2.0);
    EXPECT_EQ(facts.instants.back().backlog, 60 - static_cast<int>(simulation.state().records.entered));
    EXPECT_GT(facts.instants.back().backlog, 5);
    EXPECT_DOUBLE_EQ(summary_of(facts, 0.0, 60.0).backlog, facts.instants.back().backlog);
}

}  // namespace
}  // namespace stopline

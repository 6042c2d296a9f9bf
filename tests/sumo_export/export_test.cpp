// Tests of export_to_sumo(): all files, or no trace after an error or an interruption.
#include "sumo_export/export.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "base/io/output.h"
#include "runs/interrupted.h"
#include "scenario/load_scenario.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

namespace fs = std::filesystem;

Scenario small_grid(const std::string& override_text = "seed=1") {
    return load_scenario(
        STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
        {"fidelity=meso", "duration=30 s", "network.grid.columns=2", "network.grid.rows=2", override_text});
}

std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    std::erase(names, "net.net.xml");  // exists only if SUMO is installed
    return names;
}

TEST(Export, WritesAllFilesAndNothingElse) {
    const TemporaryFolder folder;
    const fs::path exported = folder.path() / "new" / "sumo";
    export_to_sumo(small_grid(), 0, exported, {});
    EXPECT_EQ(names_in(exported),
              (std::vector<std::string>{"connections.con.xml", "detectors.add.xml", "edges.edg.xml", "lights.tll.xml",
                                        "nodes.nod.xml", "run.sumocfg", "vehicles.rou.xml"}));
}

TEST(Export, NamesTheMostSimilarPopulation) {
    EXPECT_EQ(population_index(small_grid("populations=[CDG, CTG-Ref]"), "CTG-Ref"), 1U);
    EXPECT_EQ(input_error_of([] { population_index(small_grid("populations=[CDG, CTG-Ref]"), "CDGX"); }),
              "there is no population 'CDGX'; did you mean 'CDG'? Known: CDG, CTG-Ref");
}

TEST(Export, TranslatesTheTrafficRules) {
    const TemporaryFolder folder;
    const auto configuration = [&](const std::string& rules) {
        export_to_sumo(small_grid("rules=" + rules), 0, folder.path(), {});
        return read_file(folder.path() / "run.sumocfg");
    };
    const std::string none = configuration("{teleport_cycles: 0, pass_blocker_greens: 0}");
    EXPECT_NE(none.find("<time-to-teleport value=\"-1\"/>"), std::string::npos);
    EXPECT_NE(none.find("<ignore-junction-blocker value=\"-1\"/>"), std::string::npos);
    const std::string both = configuration("{teleport_cycles: 3, pass_blocker_greens: 2}");
    EXPECT_NE(both.find("<time-to-teleport value=\"138\"/>"), std::string::npos) << both;
    EXPECT_NE(both.find("<ignore-junction-blocker value=\"30\"/>"), std::string::npos) << both;
}

// Induction loops keep their name and place. An approach with pockets becomes two edges. The position counts from the
// start of the edge.
TEST(Export, WritesTheLoopsOfTheScenario) {
    const TemporaryFolder folder;
    const std::string lane = "koenigin_elisabeth_str_west_in_1";
    const Scenario scenario =
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/berlin.yaml",
                      {"fidelity=meso", "duration=30 s", "network.streets=three_lanes_pockets", "measure.window=1 s",
                       "measure.loops=[{name: far, lane: " + lane + ", position: 10 m}, {name: near, lane: " + lane +
                           ", position: -10 m}]"});
    export_to_sumo(scenario, 0, folder.path(), {});
    const std::string detectors = read_file(folder.path() / "detectors.add.xml");
    const auto has = [&](const std::string& text) { return detectors.find(text) != std::string::npos; };
    EXPECT_TRUE(has("<inductionLoop id=\"far\" lane=\"koenigin_elisabeth_str_west_in.1_2\" pos=\"10.000\""))
        << detectors;
    EXPECT_TRUE(has("<inductionLoop id=\"near\" lane=\"koenigin_elisabeth_str_west_in_2\" pos=\"50.000\""))
        << detectors;
}

TEST(Export, LeavesNothingIfInterrupted) {
    const TemporaryFolder folder;
    const auto stop = [](double share) { return share < 0.3; };
    EXPECT_THROW(export_to_sumo(small_grid(), 0, folder.path() / "new" / "sumo", stop), Interrupted);
    EXPECT_FALSE(fs::exists(folder.path() / "new"));
}

TEST(Export, KeepsAnEarlierExportIfInterrupted) {
    const TemporaryFolder folder;
    write_file(folder.path() / "nodes.nod.xml", "earlier");
    const auto stop = [](double share) { return share < 0.3; };
    EXPECT_THROW(export_to_sumo(small_grid(), 0, folder.path(), stop), Interrupted);
    EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"nodes.nod.xml"});
    EXPECT_EQ(read_file(folder.path() / "nodes.nod.xml"), "earlier");
    export_to_sumo(small_grid(), 0, folder.path(), {});
    EXPECT_NE(read_file(folder.path() / "nodes.nod.xml"), "earlier");
}

TEST(Export, CreatesNoFolderIfRefused) {
    const TemporaryFolder folder;
    Scenario scenario = small_grid();
    scenario.network.kind = "sumo";
    EXPECT_THROW(export_to_sumo(scenario, 0, folder.path() / "new", {}), InputError);
    EXPECT_FALSE(fs::exists(folder.path() / "new"));
}

}  // namespace
}  // namespace stopline

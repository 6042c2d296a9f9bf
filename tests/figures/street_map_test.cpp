// The map of a street network shows every lane, movement, intersection and signal programme once.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "figures/street_map.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

Scenario berlin() { return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/berlin.yaml"); }

std::string data_of(const Figure& figure, const std::string& name) {
    for (const auto& [file, text] : figure.data) {
        if (file == name) return text;
    }
    ADD_FAILURE() << "no " << name;
    return {};
}

// Returns the number of blocks of points, which empty lines separate.
std::size_t block_count(const std::string& text) {
    std::size_t count = 0;
    for (std::size_t at = text.find("\n\n"); at != std::string::npos; at = text.find("\n\n", at + 2)) ++count;
    return count;
}

TEST(StreetMap, HasOneLinePerLaneGroupedBySignal) {
    const Figure figure = street_map(berlin());
    // Signal group 0: ten intersections have three lanes from the west and three from the east, and the fourth also has
    // a turn pocket. Signal group 1 (protected left turns): the two pockets of the first intersection.
    EXPECT_EQ(block_count(data_of(figure, "network_lines_0.dat")), 10u * 6 + 1);
    EXPECT_EQ(block_count(data_of(figure, "network_lines_1.dat")), 2u);
    EXPECT_EQ(block_count(data_of(figure, "network_pockets.dat")), 3u);
    EXPECT_EQ(block_count(data_of(figure, "network_lines_2.dat")), 5u + 2 + 2 + 2 + 3 + 2 + 2 + 2 + 2);
    // Each connection has an arrow head.
    EXPECT_EQ(block_count(data_of(figure, "network_heads.dat")), block_count(data_of(figure, "network_inside.dat")));
}

TEST(StreetMap, NamesEveryIntersectionOnce) {
    const Scenario scenario = berlin();
    const Figure figure = street_map(scenario);
    for (const StreetIntersection& node : scenario.network.streets.intersections) {
        std::string label = "set label '" + node.name + "'";
        std::replace(label.begin(), label.end(), '_', ' ');
        const std::size_t first = figure.body.find(label);
        ASSERT_NE(first, std::string::npos) << label;
        EXPECT_EQ(figure.body.find(label, first + 1), std::string::npos) << label;
    }
    EXPECT_NE(figure.body.find("22/3/8/3/11/3/10 s, offset 54 s"), std::string::npos);
}

// Each signal group has a named bar with its programme. The colours of the bars differ from those of the stop lines.
TEST(StreetMap, HasANamedBarForEachSignalGroup) {
    const Figure figure = street_map(berlin());
    const auto count = [&](const std::string& part) {
        std::size_t occurrences = 0;
        for (std::size_t at = figure.body.find(part); at != std::string::npos; at = figure.body.find(part, at + 1))
            ++occurrences;
        return occurrences;
    };
    EXPECT_EQ(count("set label 'major' at "), 10u);
    EXPECT_EQ(count("set label 'left' at "), 1u);
    EXPECT_EQ(count("set label 'minor' at "), 9u);  // none at the pedestrian signal
    const auto colour_of = [&](const std::string& file) {
        const std::size_t from = figure.body.find("rgb '", figure.body.find("'" + file + "'")) + 5;
        return figure.body.substr(from, 7);
    };
    for (const char* const light : {"network_light_0.dat", "network_light_1.dat", "network_light_2.dat"}) {
        for (const char* const line : {"network_lines_0.dat", "network_lines_1.dat", "network_lines_2.dat"}) {
            EXPECT_NE(colour_of(light), colour_of(line)) << light << ", " << line;
        }
    }
    EXPECT_NE(figure.body.find("title 'red (thin line)'"), std::string::npos);
}

TEST(StreetMap, CanBeDrawn) {
    if (!gnuplot_installed()) GTEST_SKIP() << "no gnuplot";
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "stopline_street_map_test";
    std::filesystem::create_directories(folder);
    const std::vector<std::filesystem::path> files = draw(street_map(berlin()), folder);
    EXPECT_GT(std::filesystem::file_size(files[0]), 10'000u);
    EXPECT_GT(std::filesystem::file_size(files[1]), 10'000u);
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace stopline

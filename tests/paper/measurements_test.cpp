// Stored measurements are reused only by the same program with the same scenario.
#include "paper/measurements.h"

#include <gtest/gtest.h>

#include <cmath>

#include "runs/short_scenario.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

Measurements example_measurements() {
    Measurements measured;
    measured.set("passed CDG 15", 17);
    measured.set("improvement, \"so\"", 1.0 / 3.0);
    measured.set("tiny", 5e-324);
    measured.set("not found", std::nan(""));
    return measured;
}

TEST(Measurements, AreRestoredExactly) {
    const TemporaryFolder folder;
    store_measurements(folder.path() / "m.csv", "key 1", example_measurements());
    const auto loaded = load_measurements(folder.path() / "m.csv", "key 1");
    ASSERT_TRUE(loaded);
    EXPECT_EQ(loaded->values().size(), 4U);
    EXPECT_EQ(loaded->find("improvement, \"so\""), 1.0 / 3.0);
    EXPECT_EQ(loaded->find("tiny"), 5e-324);
    EXPECT_TRUE(std::isnan(*loaded->find("not found")));
    EXPECT_FALSE(loaded->find("never measured"));
}

TEST(Measurements, AreNotReusedWithAnotherKey) {
    const TemporaryFolder folder;
    store_measurements(folder.path() / "m.csv", "key 1", example_measurements());
    EXPECT_FALSE(load_measurements(folder.path() / "m.csv", "key 2"));
    EXPECT_FALSE(load_measurements(folder.path() / "none.csv", "key 1"));
}

TEST(Measurements, AreNotReusedFromADamagedFile) {
    const TemporaryFolder folder;
    for (const char* text : {"", "name,value\n", "name,value\nkey,key 1\na,seven\n", "name,value\nkey,key 1\na\n",
                             "name\nkey\n", "\xff\xfe\"", "name,value\na,7\n"}) {
        EXPECT_FALSE(load_measurements(folder.write("m.csv", text), "key 1")) << text;
    }
}

TEST(Measurements, AreNotReusedIfANumberHasChanged) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "m.csv";
    store_measurements(file, "key 1", example_measurements());
    std::string text = read_text(file);
    text.replace(text.find("17"), 2, "16");
    folder.write("m.csv", text);
    EXPECT_FALSE(load_measurements(file, "key 1"));
    text.resize(text.find("tiny"));
    folder.write("m.csv", text);
    EXPECT_FALSE(load_measurements(file, "key 1")) << "rows are missing";
}

TEST(ResultsKey, ChangesWithTheScenario) {
    const auto key = results_key(short_scenario());
    ASSERT_TRUE(key);
    EXPECT_EQ(key, results_key(short_scenario()));
    EXPECT_NE(key, results_key(short_scenario({"seed=2"})));
    EXPECT_NE(key, results_key(short_scenario({"policies[CDG].standstill_gap=3 m"})));
    EXPECT_NE(key, results_key(short_scenario({"vehicle.mass=1236 kg"})));
}

}  // namespace
}  // namespace stopline

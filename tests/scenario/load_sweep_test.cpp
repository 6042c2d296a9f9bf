// Tests of sweep files: values, checks and messages.
#include "scenario/sweep_file/load_sweep.h"

#include <gtest/gtest.h>

#include "scenario/scenario_text.h"

namespace stopline {
namespace {

std::string sweep_error(const std::string& text) {
    return input_error_of([&] { parse_sweep(text, "test.yaml"); });
}

std::string axis_error(const std::string& axis) { return sweep_error("scenario: a.yaml\naxes:\n- " + axis + "\n"); }

TEST(LoadSweep, ReadsAxesAndRepetitions) {
    const TemporaryFolder folder;
    folder.write("a.yaml", "name: a\n");
    const SweepSettings sweep = parse_sweep(
        "scenario: ../a.yaml\naxes:\n- {name: g, path: signal.green, values: [5 s, 10 s]}\n- {name: p, populations: all}\n"
        "repetitions: 6\n",
        "folder/my sweep.yaml", folder.path() / "folder");
    EXPECT_EQ(sweep.name, "my_sweep");
    EXPECT_EQ(sweep.scenario, (folder.path() / "a.yaml").string());
    ASSERT_EQ(sweep.axes.size(), 2U);
    EXPECT_EQ(sweep.axes[0].paths, std::vector<std::string>{"signal.green"});
    EXPECT_EQ(sweep.axes[0].values, (std::vector<std::string>{"5 s", "10 s"}));
    EXPECT_EQ(sweep.axes[1].populations, std::vector<std::string>{"all"});
    EXPECT_EQ(sweep.repetitions, 6);
    EXPECT_EQ(axis_overrides(sweep.axes[0], 1), std::vector<std::string>{"signal.green=10 s"});
}

TEST(LoadSweep, AppliesOneValueToAllPathsOrOneToEach) {
    const SweepAxis axis{"a", {"signal.green", "signal.yellow"}, {"5 s", "6 s | 3 s", "1 s | 2 s | 3 s"}, {}};
    EXPECT_EQ(axis_overrides(axis, 0), (std::vector<std::string>{"signal.green=5 s", "signal.yellow=5 s"}));
    EXPECT_EQ(axis_overrides(axis, 1), (std::vector<std::string>{"signal.green=6 s", "signal.yellow=3 s"}));
    EXPECT_TRUE(contains(axis_error("{name: a, path: [signal.green, signal.yellow], values: [1 s | 2 s | 3 s]}"),
                         "test.yaml:3:59: field 'axes[a].values[0]': '1 s | 2 s | 3 s' does not fit 2 paths"));
}

TEST(LoadSweep, ErrorsNamePlaceFieldAndAllowedValues) {
    EXPECT_TRUE(contains(sweep_error("axes: []\n"), "field 'scenario' is missing"));
    EXPECT_TRUE(
        contains(sweep_error("scenario: a\nrepetition: 2\n"), "test.yaml:2:1: field 'repetition' is unknown; did"));
    EXPECT_TRUE(contains(sweep_error("scenario: a\nrepetitions: 0\n"), "(allowed: 1 to 1000000)"));
    EXPECT_TRUE(
        contains(axis_error("{name: a, path: signal.gren, values: [5 s]}"),
                 "test.yaml:3:19: field 'axes[a].path[0]': field 'signal.gren' is unknown; did you mean 'green'?"));
    EXPECT_TRUE(contains(axis_error("{name: a, path: signal.green.x, values: [5 s]}"), "has no field 'x' inside"));
    EXPECT_TRUE(contains(axis_error("{name: a, path: time_gap, values: [5 s]}"), "' or 'policies[NAME].time_gap'?"));
    EXPECT_TRUE(contains(axis_error("{name: a, path: policies.CTG-Ref.time_gap, values: [1 s]}"),
                         "is a list: name its entry in brackets, as in 'policies[CTG-Ref].time_gap'"));
    EXPECT_TRUE(
        contains(sweep_error("title: \"x\nscenario: a.yaml\n"), "test.yaml:1:8: this text begins with the quote"));
    EXPECT_TRUE(contains(axis_error("{name: a, path: signal.green, values: [5 s, 6]}"),
                         "test.yaml:3:47: field 'axes[a]: signal.green': value '6' has no unit"));
    EXPECT_TRUE(contains(axis_error("{name: a, path: signal.green, values: []}"), "has 0 entries"));
    EXPECT_TRUE(contains(axis_error("{name: a, path: signal.green}"), "the axis has no values"));
    EXPECT_TRUE(contains(axis_error("{name: a}"), "needs a path and values, or populations"));
    EXPECT_TRUE(contains(axis_error("{name: a, path: signal.green, values: [5 s, 5 s]}"), "appears twice"));
    EXPECT_TRUE(contains(axis_error("{name: a, path: signal.green, values: [5 s], populations: all}"), "either"));
    EXPECT_TRUE(contains(axis_error("{name: a, path: seed, values: [1, 2]}"), "write 'repetitions'"));
    EXPECT_TRUE(contains(axis_error("{name: a, path: populations, values: [1, 2]}"), "write 'populations: [NAME"));
    EXPECT_TRUE(contains(axis_error("{name: seed, path: signal.green, values: [5 s]}"), "belongs to another column"));
    EXPECT_TRUE(contains(axis_error("{name: a, path: demand.kind, values: [queue, jam]}"), "value 'jam' is unknown"));
    EXPECT_TRUE(contains(axis_error("{name: a, path: signal.green, values: ['[5 s']}"), "not valid YAML"));
    EXPECT_TRUE(contains(axis_error("{name: a, path: signal.green, values: ['']}"), "needs a single value"));
}

TEST(LoadSweep, ErrorsNameThePlaceOfAMissingScenario) {
    const TemporaryFolder folder;
    const std::string file = folder.write("sweep.yaml", "title: x\nscenario: rte.yaml\n").string();
    EXPECT_EQ(input_error_of([&] { load_sweep(file); }),
              file + ":2:11: field 'scenario': value 'rte.yaml' leads to " + (folder.path() / "rte.yaml").string() +
                  ": no such file (relative paths start at the sweep file's folder)");
    // Other errors are reported together with the error of the missing scenario.
    const std::string both = sweep_error("scenario: none.yaml\naxes:\n- {name: a, path: signal.green, values: [5]}\n");
    EXPECT_TRUE(contains(both, "test.yaml:1:11: field 'scenario': value 'none.yaml' leads to none.yaml: no such file"));
    EXPECT_TRUE(contains(both, "test.yaml:3:42: field 'axes[a]: signal.green': value '5' has no unit"));
    EXPECT_TRUE(contains(sweep_error("scenario: ..\n"), "field 'scenario': value '..' leads to ..: is a directory"));
    folder.write("rete.yaml", "name: x\n");
    EXPECT_TRUE(
        contains(input_error_of([&] { load_sweep(file); }),
                 "no such file; did you mean '" + (folder.path() / "rete.yaml").string() + "'? (relative paths start"));
    folder.write("rte.yaml", "name: x\n");
    EXPECT_EQ(input_error_of([&] { load_sweep(file); }), "");
}

TEST(LoadSweep, ChecksAxesAgainstEachOther) {
    EXPECT_TRUE(contains(axis_error("{name: a, populations: all}\n- {name: b, populations: all}"),
                         "only one axis may have populations"));
    EXPECT_TRUE(contains(axis_error("{name: a, populations: all}\n- {name: a, path: signal.green, values: [5 s]}"),
                         "the name 'a' appears twice"));
    EXPECT_TRUE(contains(axis_error("{name: a, path: signal.green, values: [5 s]}\n"
                                    "- {name: b, path: signal.green, values: [6 s]}"),
                         "'signal.green' is set twice"));
}

TEST(LoadSweep, FieldsAreDescribed) {
    for (const char* field : {"repetitions", "populations", "scenario", "axes[]"}) {
        EXPECT_TRUE(contains(describe_sweep_fields(), field));
    }
}

TEST(LoadSweep, ScenarioIsRefusedAsAWhole) {
    EXPECT_EQ(sweep_error("network: {kind: grid}\npopulations: [CDG]\n"),
              "test.yaml:1:1: is a scenario, not a sweep (it has the field 'network'); run it with stopline-run");
}

TEST(LoadSweep, ShippedSweepsAreRead) {
    for (const auto& entry : std::filesystem::directory_iterator(shipped("scenarios/sweeps"))) {
        EXPECT_EQ(input_error_of([&] { load_sweep(entry.path()); }), "");
    }
}

}  // namespace
}  // namespace stopline

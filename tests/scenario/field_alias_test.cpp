// Tests of old names of fields and values. They are still read, with a warning that names the place and the new name.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "scenario/scenario_text.h"
#include "scenario/schema/field_path.h"
#include "scenario/schema/fields.h"
#include "scenario/sweep_file/load_sweep.h"
#include "scenario/visit_rows.h"

namespace stopline {
namespace {

using Lines = std::vector<std::string>;

constexpr const char* kGrid = "network: {kind: grid}\n";
constexpr const char* kRemoval = "; the old name will be removed in the next release";

Scenario load(const std::string& text, const Lines& overrides = {}) {
    return parse_scenario(text, "my.yaml", overrides);
}

TEST(FieldAlias, OldNamesInAFileGiveAWarningWithTheirPlace) {
    const Scenario s =
        load("network: {kind: grid}\nrules:\n  keep_clear: on\n  light_ahead: off\nmeasure: {steady: 300 s}\n");
    EXPECT_EQ(s.rules.count_queue_at_red_exit, "off");
    EXPECT_EQ(s.measure.window_s, 300.0);
    EXPECT_EQ(s.warnings,
              (Lines{std::string("my.yaml:4:3: field 'rules.light_ahead' is now called "
                                 "'rules.count_queue_at_red_exit'") +
                         kRemoval,
                     std::string("my.yaml:5:11: field 'measure.steady' is now called 'measure.window'") + kRemoval}));
}

TEST(FieldAlias, CurrentNamesGiveNoWarning) {
    EXPECT_TRUE(load("rules: {keep_clear: on, count_queue_at_red_exit: off}\n").warnings.empty());
    EXPECT_TRUE(load(kGrid, {"measure.window=300 s"}).warnings.empty());
    for (const auto& entry : std::filesystem::directory_iterator(shipped("scenarios"))) {
        if (entry.path().extension() != ".yaml") continue;
        EXPECT_EQ(load_scenario(entry.path()).warnings, Lines{}) << entry.path();
    }
    for (const auto& entry : std::filesystem::directory_iterator(shipped("scenarios/sweeps"))) {
        EXPECT_EQ(load_sweep(entry.path()).warnings, Lines{}) << entry.path();
    }
    for (const std::string& name : data_names("meso")) {
        Lines warnings;
        load_meso(name, ".", &warnings);
        EXPECT_EQ(warnings, Lines{}) << name;
    }
}

TEST(FieldAlias, OldAndNewNamesMeanTheSame) {
    EXPECT_EQ(canonical_text(load(kGrid + std::string("measure: {steady: 300 s, outside: 5 m}\n"))),
              canonical_text(load(kGrid + std::string("measure: {window: 300 s, area_margin: 5 m}\n"))));
}

TEST(FieldAlias, WorksInOverrides) {
    const Scenario s = load(kGrid + std::string("measure: {window: 100 s}\n"),
                            {"measure.steady=300 s", "rules={keep_clear: on, light_ahead: off}"});
    EXPECT_EQ(s.measure.window_s, 300.0);
    EXPECT_EQ(s.rules.count_queue_at_red_exit, "off");
    EXPECT_EQ(s.warnings, (Lines{std::string("--set 'measure.steady=300 s': field 'measure.steady' is now called "
                                             "'measure.window'") +
                                     kRemoval,
                                 std::string("--set 'rules={keep_clear: on, light_ahead: off}': field "
                                             "'rules.light_ahead' is now called 'rules.count_queue_at_red_exit'") +
                                     kRemoval}));
}

TEST(FieldAlias, OverridesReachFieldsGivenByTheirOldNames) {
    const Scenario s = load(kGrid + std::string("measure: {steady: 100 s}\n"), {"measure.window=300 s"});
    EXPECT_EQ(s.measure.window_s, 300.0);
    EXPECT_EQ(s.warnings.size(), 1u);
}

TEST(FieldAlias, OldAndNewNameTogetherAreRefused) {
    EXPECT_EQ(error_of("network: {kind: grid}\nmeasure:\n  window: 300 s\n  steady: 300 s\n"),
              "test.yaml:4:3: field 'measure.steady' is the old name of 'measure.window', which is given too: keep the "
              "new name only");
    EXPECT_EQ(error_of("network: {kind: grid}\nmeasure:\n  steady: 300 s\n  window: 300 s\n"),
              "test.yaml:3:3: field 'measure.steady' is the old name of 'measure.window', which is given too: keep the "
              "new name only");
    EXPECT_TRUE(contains(error_of("title: x\n", {"measure.steady=300 s", "measure.window=200 s"}),
                         "--set 'measure.window=200 s': field 'measure.steady' is the old name of 'measure.window'"));
    EXPECT_TRUE(contains(error_of("title: x\n", {"measure.window=200 s", "measure.steady=300 s"}),
                         "--set 'measure.steady=300 s': field 'measure.steady' is the old name of 'measure.window'"));
}

TEST(FieldAlias, WorksForValues) {
    const std::string grid = "network: {kind: grid}\nduration: 600 s\n";
    const Scenario s = load(grid + "demand:\n  cross_turns: own\n  cross_left: 10 %\n");
    EXPECT_EQ(s.demand.cross_turns, "separate");
    EXPECT_EQ(s.demand.cross_left_share, 0.1);
    EXPECT_EQ(s.warnings,
              Lines{std::string("my.yaml:4:16: field 'demand.cross_turns': value 'own' is now called 'separate'") +
                    kRemoval});
    const Scenario set = load(grid, {"demand.cross_turns=alike"});
    EXPECT_EQ(set.demand.cross_turns, "same");
    EXPECT_EQ(set.warnings, Lines{std::string("--set 'demand.cross_turns=alike': field 'demand.cross_turns': value "
                                              "'alike' is now called 'same'") +
                                  kRemoval});
}

TEST(FieldAlias, WorksInDataFiles) {
    const TemporaryFolder folder;
    folder.write("driver.yaml", "base: startup_kit\nlane_change:\n  help: on\n");
    folder.write("meso.yaml", "base: passages\nrelayed: 2\nconstant_time: {catch_up: 2}\n");
    const std::string file =
        folder.write("s.yaml", "driver: {base: ./driver.yaml, give_way: {approach: 1 m/s2}}\nmeso: ./meso.yaml\n");
    const Scenario s = load_scenario(file);
    EXPECT_EQ(s.driver.lane_change.gap_opening, "on");
    EXPECT_EQ(s.driver.give_way.approach_acceleration_mps2, 1.0);
    EXPECT_EQ(s.meso.start_relay_vehicles, 2);
    EXPECT_EQ(s.meso.constant_time.catch_up_factor, 2.0);
    ASSERT_EQ(s.warnings.size(), 4u);
    EXPECT_TRUE(std::any_of(s.warnings.begin(), s.warnings.end(), [](const std::string& line) {
        return line.find(
                   "driver.yaml:3:3: field 'driver.lane_change.help' is now called "
                   "'driver.lane_change.gap_opening'") != std::string::npos;
    }));

    Lines warnings;
    EXPECT_EQ(load_meso("./meso.yaml", folder.path(), &warnings).start_relay_vehicles, 2);
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_TRUE(contains(warnings[0], "meso.yaml:2:1: field 'meso.relayed' is now called 'meso.start_relay_vehicles'"));
}

TEST(FieldAlias, WorksInListEntries) {
    const TemporaryFolder folder;
    folder.write("streets.yaml",
                 "intersections:\n- name: first\n  arms:\n"
                 "  - {from: west, lanes: [{movements: straight}], exits: 1}\n"
                 "  - {from: east, lanes: [{movements: straight}], exits: 1}\n");
    const Scenario s = load_scenario(folder.write("s.yaml", "network: {kind: streets, streets: ./streets.yaml}\n"),
                                     {"network.streets.intersections[first].arms[0].length=200 m"});
    EXPECT_EQ(s.network.streets.intersections[0].legs[0].length_m, 200.0);
    ASSERT_EQ(s.warnings.size(), 2u);
    EXPECT_TRUE(contains(s.warnings[0] + s.warnings[1],
                         "streets.yaml:3:3: field 'network.streets.intersections[first].arms' is now called "
                         "'network.streets.intersections[first].legs'"));
}

TEST(FieldAlias, WorksInSweepAxes) {
    const TemporaryFolder folder;
    folder.write("a.yaml", "name: a\n");
    const SweepSettings sweep = parse_sweep(
        "scenario: a.yaml\naxes:\n- {name: w, path: [duration, measure.steady], values: [400 s | 300 s]}\n"
        "- {name: t, path: demand.cross_turns, values: [alike, separate]}\n",
        "sweep.yaml", folder.path());
    EXPECT_EQ(sweep.axes[0].paths, (Lines{"duration", "measure.window"}));
    EXPECT_EQ(sweep.axes[1].values, (Lines{"same", "separate"}));
    EXPECT_EQ(axis_overrides(sweep.axes[0], 0), (Lines{"duration=400 s", "measure.window=300 s"}));
    EXPECT_EQ(sweep.warnings,
              (Lines{std::string("sweep.yaml:3:30: field 'measure.steady' is now called 'measure.window'") + kRemoval,
                     std::string("sweep.yaml:4:48: field 'demand.cross_turns': value 'alike' is now called 'same'") +
                         kRemoval}));
    EXPECT_TRUE(contains(input_error_of([&] {
                             parse_sweep(
                                 "scenario: a.yaml\naxes:\n- {name: a, path: measure.steady, values: [300 s]}\n"
                                 "- {name: b, path: measure.window, values: [200 s]}\n",
                                 "sweep.yaml", folder.path());
                         }),
                         "'measure.window' is set twice"));
}

TEST(FieldAlias, PathsKeepTheirEntries) {
    EXPECT_EQ(current_path(scenario_table(), "network.streets.intersections[a.b].arms[0].lanes"),
              "network.streets.intersections[a.b].legs[0].lanes");
    for (const char* path : {"measure.window", "measure.green[1]", "signal.gren", "a[=1", ""}) {
        EXPECT_EQ(current_path(scenario_table(), path), path);
    }
}

TEST(FieldAlias, OldNamesDifferFromAllCurrentNames) {
    visit_rows(scenario_table(), "", [](const Table& table, const Field& field, const std::string& path) {
        for (const std::string& old_name : field.old_names) {
            EXPECT_EQ(table.find(old_name), nullptr) << path;
            EXPECT_EQ(table.find_old_name(old_name), &field) << path;
        }
        if (field.old_values.empty()) return;
        const auto* const choice = std::get_if<ChoiceField>(&field.kind);
        ASSERT_NE(choice, nullptr) << path;
        const std::set<std::string> names(choice->names.begin(), choice->names.end());
        for (const OldValue& old : field.old_values) {
            EXPECT_FALSE(names.contains(old.old_name)) << path;
            EXPECT_TRUE(names.contains(old.name)) << path;
        }
    });
}

}  // namespace
}  // namespace stopline

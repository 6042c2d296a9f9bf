// Tests of the reductions: a CSV file that shortens sweeps and scenarios for quick runs, for example to fewer seeds.
#include "paper/reductions.h"

#include <gtest/gtest.h>

#include "base/io/data_directory.h"
#include "scenario/load_scenario.h"
#include "scenario/scenario_text.h"
#include "scenario/sweep_file/load_sweep.h"

namespace stopline {
namespace {

Reductions reductions_of(const std::string& rows) {
    const TemporaryFolder folder;
    return Reductions::load(folder.write("quick.csv", "applies_to,field,value\n" + rows));
}

SweepSettings example_sweep() {
    SweepSettings sweep;
    sweep.name = "grid";
    sweep.axes = {{"green", {"signal.green"}, {"5 s", "10 s", "15 s"}, {}}, {"population", {}, {}, {"all"}}};
    sweep.repetitions = 6;
    return sweep;
}

TEST(Reductions, KeepTheListedValues) {
    SweepSettings sweep = example_sweep();
    reductions_of("sweeps/grid,axis green,5 s; 15 s\nsweeps/grid,repetitions,2\nsweeps/other,repetitions,1\n")
        .apply(sweep);
    EXPECT_EQ(sweep.axes[0].values, (std::vector<std::string>{"5 s", "15 s"}));
    EXPECT_EQ(sweep.axes[1].populations, std::vector<std::string>{"all"});
    EXPECT_EQ(sweep.repetitions, 2);
}

TEST(Reductions, ChangeNothingWithoutRows) {
    SweepSettings sweep = example_sweep();
    Reductions().apply(sweep);
    EXPECT_EQ(sweep.axes[0].values.size(), 3U);
    EXPECT_EQ(sweep.repetitions, 6);
    EXPECT_TRUE(Reductions().settings("sweeps/grid").empty());
    EXPECT_FALSE(Reductions().repetitions("sweeps/grid"));
}

TEST(Reductions, GiveOverridesForOneFileOnly) {
    const Reductions reductions =
        reductions_of("sweeps/grid,duration,600 s\nsweeps/grid,axis green,5 s\nscenarios/grid,duration,300 s\n");
    EXPECT_EQ(reductions.settings("sweeps/grid"), std::vector<std::string>{"duration=600 s"});
    EXPECT_EQ(reductions.settings("scenarios/grid"), std::vector<std::string>{"duration=300 s"});
}

TEST(Reductions, RefuseUnknownAxesAndValues) {
    SweepSettings sweep = example_sweep();
    const auto error = [&](const std::string& row) { return input_error_of([&] { reductions_of(row).apply(sweep); }); };
    EXPECT_NE(error("sweeps/grid,axis gren,5 s\n").find("no axis 'gren'"), std::string::npos);
    EXPECT_NE(error("sweeps/grid,axis green,7 s\n").find("no value '7 s'; its values: 5 s; 10 s; 15 s"),
              std::string::npos);
    EXPECT_NE(error("sweeps/grid,repetitions,many\n").find("quick.csv:2: 'many' is not a number"), std::string::npos);
    EXPECT_NE(error("sweeps/grid,repetitions,\n").find("quick.csv:2"), std::string::npos);
}

TEST(Reductions, AreReadWithTheOldColumnName) {
    const TemporaryFolder folder;
    const Reductions reductions =
        Reductions::load(folder.write("quick.csv", "what,field,value\nsweeps/grid,repetitions,2\n"));
    EXPECT_EQ(reductions.repetitions("sweeps/grid"), 2);
    ASSERT_EQ(reductions.warnings().size(), 1U);
    EXPECT_TRUE(contains(reductions.warnings().front(), "quick.csv: column 'what' is now called 'applies_to'"));
    EXPECT_TRUE(reductions_of("sweeps/grid,repetitions,2\n").warnings().empty());
}

TEST(Reductions, ShippedFileFitsTheShippedSweeps) {
    const Reductions reductions = Reductions::load(data_directory() / "paper" / "quick.csv");
    const std::filesystem::path scenarios = scenario_directory();
    ASSERT_FALSE(reductions.rows().empty());
    for (const Reductions::Row& row : reductions.rows()) {
        const bool is_sweep = row.applies_to.starts_with("sweeps/");
        ASSERT_TRUE(is_sweep || row.applies_to.starts_with("scenarios/")) << row.applies_to;
        const std::string name = row.applies_to.substr(row.applies_to.find('/') + 1);
        if (is_sweep) {
            SweepSettings settings = load_sweep(scenarios / "sweeps" / (name + ".yaml"));
            EXPECT_NO_THROW(reductions.apply(settings)) << row.applies_to;
        } else {
            EXPECT_NO_THROW(
                static_cast<void>(load_scenario(scenarios / (name + ".yaml"), reductions.settings(row.applies_to))))
                << row.applies_to;
        }
    }
}

}  // namespace
}  // namespace stopline

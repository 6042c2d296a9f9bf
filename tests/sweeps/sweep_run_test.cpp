// Sweeps give the same table when they run without a break, continue after an interruption, or are joined from shards.
#include "sweeps/sweep_run.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "base/io/csv.h"
#include "base/io/output.h"
#include "runs/interrupted.h"
#include "sweeps/short_sweep.h"
#include "sweeps/sweep_merge.h"
#include "sweeps/sweep_results.h"

namespace stopline {
namespace {

// Returns made-up metrics without a simulation.
std::vector<RunMetric> quick_run(const Scenario& scenario, std::size_t population,
                                 const std::function<bool()>& keep_going) {
    if (!keep_going()) return {};
    return {{"passed_veh", std::to_string(100 * population + scenario.seed)},
            {"green_s_seen", fixed(scenario.signal.green_s, 3)},
            {"overlaps", "0"},
            {"updates", "1000"}};
}

std::vector<RunMetric> failing_run(const Scenario& scenario, std::size_t population,
                                   const std::function<bool()>& keep_going) {
    if (population == 1 && scenario.seed == 2) throw std::runtime_error("no road");
    return quick_run(scenario, population, keep_going);
}

class SweepRunTest : public ::testing::Test {
protected:
    StoreIdentity identity(const Shard& shard = {}) const {
        const std::string part = shard.count > 1 ? std::to_string(shard.index) : "";
        return {"sweep", sweep_.key(), "program", sweep_.points(), part, "{}\n"};
    }
    RunStore store(const std::string& name, const Shard& shard = {}) const {
        return RunStore::open_or_make(path(name), identity(shard));
    }
    std::filesystem::path path(const std::string& name) const { return files_.folder.path() / name; }

    SweepSession run(RunStore& into, int threads = 1, const Shard& shard = {}, RunFunction function = quick_run) const {
        return run_points(sweep_, missing_points(sweep_, shard, into), into, {threads, {}, function});
    }
    std::string whole_csv() const {
        RunStore all = store("whole.sqlite");
        run(all);
        return sweep_results(all).csv;
    }
    std::string merge_error(const std::vector<std::string>& names) const {
        std::vector<std::filesystem::path> stores;
        for (const std::string& name : names) stores.push_back(path(name));
        return input_error_of([&] { merge_stores(stores, files_.folder.path()); });
    }

    ShortSweep files_;
    Sweep sweep_ = files_.load();
};

TEST_F(SweepRunTest, TableHasOneRowPerRunInTheOrderOfPoints) {
    const CsvTable table = parse_csv(whole_csv(), "table");
    ASSERT_EQ(table.rows.size(), sweep_.points());
    EXPECT_EQ(table.columns, (std::vector<std::string>{"point", "green_s", "vehicle", "population", "seed",
                                                       "passed_veh", "green_s_seen", "overlaps", "updates"}));
    for (std::size_t point = 0; point < table.rows.size(); ++point) {
        const std::vector<std::string>& row = table.rows[point];
        EXPECT_EQ(row[0], std::to_string(point));
        EXPECT_EQ(row[6], row[1] + ".000");
        EXPECT_EQ(row[5], std::to_string(100 * (point / 2 % 3) + point % 2 + 1));
    }
}

TEST_F(SweepRunTest, SimulationsGiveTheSameTableOnAnyNumberOfThreads) {
    RunStore one_thread = store("one.sqlite");
    RunStore three_threads = store("three.sqlite");
    EXPECT_EQ(run(one_thread, 1, {}, run_metrics).runs, sweep_.points());
    const SweepSession session = run(three_threads, 3, {}, run_metrics);
    const SweepTable table = sweep_results(three_threads);
    EXPECT_EQ(sweep_results(one_thread).csv, table.csv);
    EXPECT_EQ(session.updates, table.totals.updates);
    EXPECT_GT(session.updates, 0);
    EXPECT_EQ(table.totals.runs_with_violations, 0U);
    const CsvTable rows = parse_csv(table.csv, "table");
    const std::size_t hash = rows.column("state_hash");
    EXPECT_NE(rows.rows[2][hash], rows.rows[3][hash]) << "a random mix depends on the seed";
    EXPECT_GT(std::stoi(rows.rows[0][rows.column("passed_2_veh")]), 3);
}

TEST_F(SweepRunTest, ContinuesAfterAnInterruption) {
    const std::string whole = whole_csv();
    RunStore part = store("part.sqlite");
    int calls = 0;
    const auto until_fifth = [&](double) { return ++calls < 5; };
    EXPECT_THROW(run_points(sweep_, missing_points(sweep_, {}, part), part, {1, until_fifth, quick_run}), Interrupted);
    const std::size_t remaining = missing_points(sweep_, {}, part).size();
    EXPECT_GT(remaining, 0U);
    EXPECT_LT(remaining, sweep_.points());
    EXPECT_EQ(run(part).runs, remaining);
    EXPECT_EQ(sweep_results(part).csv, whole);
    EXPECT_EQ(run(part).runs, 0U);
}

TEST_F(SweepRunTest, FailingRunsDoNotStopTheOthers) {
    RunStore part = store("part.sqlite");
    const SweepSession session = run(part, 2, {}, failing_run);
    ASSERT_EQ(session.failures.size(), 4U);
    EXPECT_EQ(session.failures[0].point, 3U);
    EXPECT_EQ(session.failures[0].message, "no road");
    EXPECT_EQ(session.runs, sweep_.points() - 4U);
    EXPECT_EQ(run(part).runs, 4U);
    EXPECT_EQ(sweep_results(part).csv, whole_csv());
}

TEST_F(SweepRunTest, ChangedScenarioStopsTheSweep) {
    RunStore part = store("part.sqlite");
    files_.folder.write("short.yaml", std::string(kShortSweepScenario) + "step: 20 ms\n");
    EXPECT_TRUE(contains(input_error_of([&] { run(part, 2); }), "has changed"));
}

TEST_F(SweepRunTest, ShardsJoinToTheSameTable) {
    const std::string whole = whole_csv();
    for (std::size_t k = 1; k <= 3; ++k) {
        RunStore part = store("shard" + std::to_string(k), {k, 3});
        run(part, 1, {k, 3});
    }
    EXPECT_TRUE(contains(merge_error({"shard1", "shard3"}), "8 of 24 runs are missing: "));
    EXPECT_TRUE(contains(merge_error({"shard1", "shard2", "shard3", "whole.sqlite"}), "overlap: both have run"));
    EXPECT_TRUE(contains(merge_error({"shard1", "shard2", "shard1"}), "given twice"));
    EXPECT_FALSE(std::filesystem::exists(path("sweep.csv")));
    EXPECT_EQ(merge_error({"shard3", "shard1", "shard2"}), "");
    EXPECT_EQ(read_file(path("sweep.csv")), whole);
    EXPECT_EQ(read_file(path("sweep.provenance.json")), "{}\n");
    EXPECT_TRUE(missing_points(sweep_, {}, RunStore::open(path("sweep.sqlite"))).empty());
    EXPECT_TRUE(contains(merge_error({"shard1", "shard2", "shard3"}), "the store exists already"));
}

TEST_F(SweepRunTest, StoresOfDifferentSweepsAreNotJoined) {
    static_cast<void>(store("own"));
    StoreIdentity other = identity();
    other.sweep = "0";
    static_cast<void>(RunStore::open_or_make(path("changed"), other));
    other = identity();
    other.program = "other";
    static_cast<void>(RunStore::open_or_make(path("built"), other));
    EXPECT_TRUE(contains(merge_error({"own", "changed"}), "their sweeps or scenarios differ"));
    EXPECT_TRUE(contains(merge_error({"own", "built"}), "different builds"));
}

TEST(SweepResults, AxesMustNotHaveTheNameOfAMetric) {
    const ShortSweep files("scenario: short.yaml\naxes:\n- {name: measured, path: demand.vehicles, values: [8]}\n");
    const Sweep sweep = files.load();
    EXPECT_TRUE(contains(input_error_of([&] { result_text(sweep, 0, {{"measured", "1"}}); }), "rename the axis"));
    EXPECT_EQ(count_in("a=1\nupdates=-12\nb=\n", "updates"), -12);
    EXPECT_EQ(count_in("a=1\nb=\n", "b"), 0);
}

SweepTotals totals_with(RunFunction function) {
    const ShortSweep files;
    const Sweep sweep = files.load();
    RunStore store = RunStore::open_or_make(files.folder.path() / "store",
                                            {"sweep", sweep.key(), "program", sweep.points(), "", "{}\n"});
    run_points(sweep, missing_points(sweep, {}, store), store, {1, {}, function});
    return sweep_results(store).totals;
}

TEST(SweepTotals, CountDeadlocksOnlyForSingleIntersections) {
    const SweepTotals light = totals_with(quick_run);
    EXPECT_FALSE(light.deadlocks.has_value());
    EXPECT_FALSE(light.gridlocks.has_value());
    const SweepTotals intersection =
        totals_with([](const Scenario&, std::size_t, const std::function<bool()>&) -> std::vector<RunMetric> {
            return {{"longest_in_junction_s", "90.00"}, {"deadlocks", "1"}};
        });
    EXPECT_EQ(intersection.deadlocks, 24);
    EXPECT_FALSE(intersection.gridlocks.has_value());
    EXPECT_EQ(intersection.runs_with_violations, 24U);
    const SweepTotals network =
        totals_with([](const Scenario&, std::size_t, const std::function<bool()>&) -> std::vector<RunMetric> {
            return {{"gridlocks", "2"}, {"teleported", "3"}, {"longest_in_junction_s", "7107.50"}, {"deadlocks", "0"}};
        });
    EXPECT_FALSE(network.deadlocks.has_value());
    EXPECT_EQ(network.gridlocks, 48);
    EXPECT_EQ(network.teleported, 72);
    EXPECT_DOUBLE_EQ(network.longest_in_junction_s, 7107.5);
    EXPECT_EQ(network.runs_with_violations, 0U);
}

TEST(SweepResults, ReadStoresOfTheLastRelease) {
    const TemporaryFolder folder;
    RunStore store = RunStore::open_or_make(folder.path() / "store", {"sweep", "key", "program", 2, "", "{}\n"});
    store.put(0, "waiting_veh_s=1\nseed=1\ngridlocks=1\nmoved_on=3\nunstable_by=fall\nwaiting_veh=2\n");
    store.put(1, "waiting_veh_s=2\nseed=1\ngridlocks=0\nmoved_on=4\nunstable_by=\nwaiting_veh=0\n");
    const SweepTable table = sweep_results(store);
    EXPECT_EQ(table.csv,
              "point,waiting_veh_s,seed,gridlocks,teleported,unstable_by,backlog\n0,1,1,1,3,throughput_drop,2\n"
              "1,2,1,0,4,,0\n");
    EXPECT_EQ(table.totals.teleported, 7);
    EXPECT_EQ(table.totals.with_backlog, 1U);
    ASSERT_EQ(table.warnings.size(), 2U);
    EXPECT_TRUE(contains(table.warnings[0], "'moved_on' is now called 'teleported'"));
}

TEST(SweepProvenance, ContainsAxesAndParametersButNoPath) {
    const ShortSweep files;
    const std::string json = sweep_provenance(files.load(), "stopline-sweep sweep.yaml");
    EXPECT_TRUE(contains(json, "\"signal.green\""));
    EXPECT_TRUE(contains(json, "\"runs\": 24"));
    EXPECT_TRUE(contains(json, "vehicles: 8"));
    EXPECT_EQ(json.find(files.folder.path().string()), std::string::npos);
}

}  // namespace
}  // namespace stopline

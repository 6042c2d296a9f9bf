// Descriptions of result columns, and their old names.
#include "runs/tables/column_docs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>

#include "runs/run_metrics.h"
#include "runs/short_scenario.h"
#include "runs/tables/column_aliases.h"

namespace stopline {
namespace {

// Returns true if a column matches the name in a description, in which CAPITALS stand for any word.
bool matches(const std::string& column, std::string_view documented) {
    const std::string pattern = std::regex_replace(std::string(documented), std::regex("[A-Z]+"), "[A-Za-z0-9_.-]+");
    return std::regex_match(column, std::regex(pattern));
}

std::vector<ColumnDoc> columns_of(std::string_view table) {
    for (const TableDoc& doc : table_docs()) {
        if (doc.name == table) return doc.columns;
    }
    ADD_FAILURE() << "no table " << table;
    return {};
}

TEST(ColumnDocs, AreCompleteAndUnique) {
    std::set<std::string_view> tables;
    for (const TableDoc& table : table_docs()) {
        EXPECT_TRUE(tables.insert(table.name).second) << table.name;
        std::set<std::string_view> columns;
        for (const ColumnDoc& column : table.columns) {
            EXPECT_TRUE(columns.insert(column.name).second) << table.name << ' ' << column.name;
            EXPECT_FALSE(column.meaning.empty()) << table.name << ' ' << column.name;
            EXPECT_EQ(column.meaning.find('|'), std::string_view::npos) << "a bar ends the cell of a Markdown table";
        }
    }
}

TEST(ColumnDocs, CoverTheMetricsOfSweeps) {
    const std::vector<ColumnDoc> documented = columns_of("sweep/NAME.csv");
    const auto shipped = [](const char* file) {
        return load_scenario(std::string(STOPLINE_SOURCE_DIR "/scenarios/") + file, {});
    };
    for (const Scenario& scenario :
         {short_scenario(), shipped("intersection.yaml"), shipped("grid.yaml"), shipped("berlin.yaml")}) {
        for (const std::string& column : result_columns(scenario)) {
            EXPECT_TRUE(std::any_of(documented.begin(), documented.end(),
                                    [&](const ColumnDoc& doc) { return matches(column, doc.name); }))
                << scenario.name << ' ' << column;
        }
    }
}

TEST(ColumnAliases, RenameColumnsAndValues) {
    EXPECT_EQ(
        with_old_names("network/summary.csv",
                       "population,max_present,unstable_by,delay_yielding_h,delay_gridlock_h,delay_upstream_h,exited\n"
                       "CDG,5,throughput_drop,1.0,2.0,3.0,4\n"),
        "population,most_present,unstable_by,lost_priority_h,lost_gridlock_h,lost_outside_h,left\n"
        "CDG,5,fall,1.0,2.0,3.0,4\n");
    EXPECT_EQ(with_old_names("network/delays.csv", "cause,max_vehicles,delay_s\nqueue_discharge,3,1.5\nsignal,1,2.0\n"),
              "cause,most_vehicles,lost_s\nstart,3,1.5\nsignal,1,2.0\n");
    EXPECT_EQ(with_old_names("single_light/trajectories.csv", "lane,position_m\n0,-1.0\n"), "lane,place_m\n0,-1.0\n");
    EXPECT_EQ(with_old_names("network/time_space.csv", "position_m\n"), "front_m\n");
    EXPECT_EQ(with_old_names("network/turns.csv", "left_target_percent\n"), "left_asked_percent\n");
    EXPECT_EQ(with_old_names("startup/startup.csv", "time_s,p2.5_kmh,p97.5_kmh\n"),
              "time_s,low_2.5_kmh,high_97.5_kmh\n");
    EXPECT_EQ(with_old_names("calibrate/permutations.csv", "pairs,within_limit_percent,pairs_in_other_green\n"),
              "pairs,within_percent,other_green\n");
    EXPECT_EQ(
        with_old_names("calibrate/fit_history.csv", "loss,constant_time.catch_up_factor,below_band_speed_share\n"),
        "loss,constant_time.catch_up,below_band\n");
    EXPECT_EQ(with_old_names("calibrate/bands_NAME.csv", "permutation,metric\nx,delay_yielding_h\n"),
              "permutation,metric\nx,lost_priority_h\n");
    EXPECT_EQ(with_old_names("compare/comparison.csv", "metric,seed\ndeparture_delay_s,1\nbacklog,1\nteleported,1\n"),
              "metric,seed\nwait_outside_s,1\nwaiting_at_end_veh,1\nmoved_on_veh,1\n");
}

TEST(ColumnAliases, DoNotRenameAxesOfSweeps) {
    EXPECT_EQ(with_old_names("sweep/NAME.csv", "point,backlog,seed,backlog,congested_from_krumme_str_s\n0,1,1,2,60\n"),
              "point,backlog,seed,waiting_veh,filled_krumme_str_s\n0,1,1,2,60\n");
    EXPECT_EQ(with_old_names("sweep/NAME_means.csv", "ci95_low,metric,ci95_low\n1,teleported,2\n"),
              "ci95_low,metric,low\n1,moved_on,2\n");
}

TEST(ColumnAliases, AreReadWithOneWarningEach) {
    OldNameReader names("sweep/NAME.csv");
    EXPECT_EQ(names.column("throughput_veh_h"), "throughput_veh_h");
    EXPECT_TRUE(names.warnings().empty());
    for (int k = 0; k < 2; ++k) {
        EXPECT_EQ(names.column("waiting_veh"), "backlog");
        EXPECT_EQ(names.column("lost_start_h"), "delay_queue_discharge_h");
        EXPECT_EQ(names.column("lost_vehicles"), "lost_vehicles");
    }
    EXPECT_EQ(names.warnings(),
              (std::vector<std::string>{
                  "column 'waiting_veh' is now called 'backlog'; the old name will be removed in the next release",
                  "column 'lost_start_h' is now called 'delay_queue_discharge_h'; the old name will be removed in "
                  "the next release"}));
    EXPECT_EQ(names.value("unstable_by", "fall"), "throughput_drop");
    EXPECT_EQ(names.value("stability", "fall"), "fall");
}

TEST(ColumnAliases, RenameTheFilesOfNetworks) {
    EXPECT_EQ(result_file("network/origin_destination.csv", "new.csv", "from\n", ColumnNames::old).name, "ways.csv");
    EXPECT_EQ(result_file("network/delays.csv", "delays.csv", "cause\n", ColumnNames::old).name, "hindrance.csv");
    const ResultFile current = result_file("network/delays.csv", "delays.csv", "delay_s\n", ColumnNames::current);
    EXPECT_EQ(current.name, "delays.csv");
    EXPECT_EQ(current.text, "delay_s\n");
}

// The documentation lists every column under its current name, never under an old one.
TEST(ColumnAliases, AreNotDescribedAsColumns) {
    for (const TableDoc& table : table_docs()) {
        OldNameReader names{std::string(table.name)};
        for (const ColumnDoc& column : table.columns) EXPECT_EQ(names.column(std::string(column.name)), column.name);
        EXPECT_TRUE(names.warnings().empty()) << table.name;
    }
}

}  // namespace
}  // namespace stopline

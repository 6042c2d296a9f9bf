// Tests of stopline-reproduce: the list of its jobs, the list of the figures in its report, and the records of finished
// jobs.
#include "paper/report/job.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/io/data_directory.h"
#include "base/io/output.h"
#include "paper/report/figure_list.h"
#include "paper/report/reproduce.h"
#include "scenario/load_scenario.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

namespace fs = std::filesystem;

TEST(JobList, HasUniqueNamesAndExpectedDurations) {
    std::set<std::string> names;
    for (const Job& job : all_jobs()) {
        EXPECT_TRUE(names.insert(job.name).second) << job.name;
        EXPECT_GT(job.expected_s, 0.0) << job.name;
        EXPECT_GT(job.quick_expected_s, 0.0) << job.name;
        EXPECT_LE(job.quick_expected_s, job.expected_s) << job.name;
        EXPECT_TRUE(job.is_needed_by(job.section)) << job.name;
    }
}

TEST(JobList, OfASectionIncludesTheJobsThatItComparesWith) {
    EXPECT_EQ(known_sections(),
              (std::vector<std::string>{"III", "IV", "V", "VI", "VII", "coordination", "energy", "all"}));
    EXPECT_EQ(jobs_of("all").size(), all_jobs().size());
    EXPECT_TRUE(jobs_of("VIII").empty());
    EXPECT_TRUE(jobs_of("").empty());
    std::set<std::string> sections;
    for (const Job* job : jobs_of("VI")) sections.insert(job->section);
    EXPECT_EQ(sections, (std::set<std::string>{"IV", "VI"}));  // Fig. 23 (Section VI) shows results of Section IV too
}

// If this test fails after a new experiment, add a job that measures the experiment, and add its name to this list.
TEST(JobList, CoversTheExperimentsOfTheScorecard) {
    const std::set<std::string> measured_by_jobs{"single_light_inputs",
                                                 "single_light",
                                                 "intersection",
                                                 "meso_parameters",
                                                 "calibration_times",
                                                 "calibration_bands",
                                                 "arterial_platoons",
                                                 "arterial",
                                                 "grid",
                                                 "grid_stability",
                                                 "berlin",
                                                 "clearing_grid",
                                                 "coordination_four_lanes",
                                                 "energy_intersection",
                                                 "energy_grid"};
    std::set<std::string> names;
    for (const Experiment& experiment : experiments()) names.insert(experiment.name);
    EXPECT_EQ(names, measured_by_jobs);
}

TEST(FigureList, NamesEachFileOnce) {
    const std::vector<ListedFigure> figures = load_figure_list(data_directory() / "paper" / "figures.csv");
    std::set<std::string> ids;
    std::set<std::string> numbers;
    for (const ListedFigure& figure : figures) {
        numbers.insert(figure.figure.substr(0, figure.figure.find(',')));
        EXPECT_FALSE(figure.title.empty()) << figure.figure;
        EXPECT_FALSE(figure.caption.empty()) << figure.figure;
        if (!figure.job.empty()) {
            EXPECT_TRUE(ids.insert(figure.id()).second) << figure.id();
        }
    }
    for (int k = 1; k <= 26; ++k) {  // every figure of the paper is drawn or has a reason why not
        EXPECT_TRUE(numbers.contains("Fig. " + std::to_string(k))) << k;
    }
}

TEST(FigureList, GivesIdsThatSortByFigureNumber) {
    ListedFigure figure{"Fig. 5, speeds", "III.E", "single_light", "platoon", "", ""};
    EXPECT_EQ(figure.id(), "fig05_platoon");
    figure = {"Fig. 26, inflow", "VII.B", "berlin", "fig26/inflow", "", ""};
    EXPECT_EQ(figure.id(), "fig26_fig26-inflow");
    figure = {"Table 1", "IV.C", "intersection_sweep", "table1.csv", "", ""};
    EXPECT_EQ(figure.id(), "table01_table1");
    EXPECT_EQ(figure.major_section(), "IV");
}

TEST(FigureList, RefusesAnUnknownJob) {
    const TemporaryFolder folder;
    const fs::path file =
        folder.write("figures.csv", "figure,section,job,file,title,caption\nFig. 5,III,singel_light,a,b,c\n");
    EXPECT_NE(input_error_of([&] { static_cast<void>(load_figure_list(file)); }).find("unknown job 'singel_light'"),
              std::string::npos);
}

JobOutput example_output() {
    JobOutput output;
    output.figures = {"sub/one"};
    output.tables = {"table.csv"};
    output.measured = {"grid"};
    output.conditions = {{"Scenario", "a \"quoted\" one"}};
    output.commands = {"stopline-run x"};
    output.seeds = {1, 2};
    output.scenario_hashes = {{"grid", 0xfedcba9876543210ULL}};
    output.violations = 3;
    return output;
}

class Record : public ::testing::Test {
protected:
    void SetUp() override {
        fs::create_directories(folder_.path() / "sub");
        for (const char* name : {"sub/one.svg", "sub/one.png", "table.csv", "measured_grid.csv"})
            folder_.write(name, name);
        store_record(folder_.path(), "key", example_output());
    }
    TemporaryFolder folder_;
};

TEST_F(Record, IsRestored) {
    const std::optional<JobOutput> read = load_record(folder_.path(), "key");
    ASSERT_TRUE(read);
    const JobOutput expected = example_output();
    EXPECT_EQ(read->figures, expected.figures);
    EXPECT_EQ(read->tables, expected.tables);
    EXPECT_EQ(read->measured, expected.measured);
    EXPECT_EQ(read->conditions, expected.conditions);
    EXPECT_EQ(read->commands, expected.commands);
    EXPECT_EQ(read->seeds, expected.seeds);
    EXPECT_EQ(read->scenario_hashes, expected.scenario_hashes);
    EXPECT_EQ(read->violations, 3);
}

TEST_F(Record, IsRejectedWithAnotherKey) { EXPECT_FALSE(load_record(folder_.path(), "another key")); }

TEST_F(Record, IsRejectedIfAFileIsMissingOrChanged) {
    folder_.write("sub/one.png", "half");
    EXPECT_FALSE(load_record(folder_.path(), "key"));
    folder_.write("sub/one.png", "sub/one.png");
    EXPECT_TRUE(load_record(folder_.path(), "key"));
    fs::remove(folder_.path() / "measured_grid.csv");
    EXPECT_FALSE(load_record(folder_.path(), "key"));
}

TEST_F(Record, IsRejectedIfDamaged) {
    const std::string whole = read_file(folder_.path() / "job.json");
    for (const std::size_t size : {std::size_t{0}, whole.size() / 2, whole.size() - 3}) {
        folder_.write("job.json", whole.substr(0, size));
        EXPECT_FALSE(load_record(folder_.path(), "key")) << size;
    }
    std::string changed = whole;  // a changed character of the text gives another valid record
    const std::size_t letter = changed.find("\"violations\": ") + 14;
    changed[letter] = changed[letter] == '1' ? '2' : '1';
    folder_.write("job.json", changed);
    EXPECT_FALSE(load_record(folder_.path(), "key"));
    folder_.write("job.json", "[]");
    EXPECT_FALSE(load_record(folder_.path(), "key"));
    fs::remove(folder_.path() / "job.json");
    EXPECT_FALSE(load_record(folder_.path(), "key"));
}

}  // namespace
}  // namespace stopline

// One new entry is enough for a new metric: all tables, lists and pages show it.
#include <gtest/gtest.h>

#include "runs/intersection/intersection_metrics.h"
#include "runs/metrics/metric_groups.h"
#include "runs/metrics/metric_tables.h"
#include "runs/network/network_metrics.h"
#include "runs/short_scenario.h"
#include "runs/single_light/single_light_metrics.h"

namespace stopline {
namespace {

Scenario shipped(const char* file) { return load_scenario(std::string(STOPLINE_SOURCE_DIR "/scenarios/") + file, {}); }

// The results of a run that counted 7 vehicles.
IntersectionResult intersection_result(const Scenario& scenario) {
    IntersectionResult result;
    result.population = "CDG";
    result.entered = 7;
    result.zones.resize(scenario.measure.zone_radius_m.size());
    result.delay_s.resize(scenario.measure.zone_radius_m.size());
    return result;
}
NetworkResult network_result() {
    NetworkResult result;
    result.population = "CDG";
    result.entered = 7;
    return result;
}

template <class Run>
Metric<Run> axle_metric() {
    return {.column = "axles_m",
            .unit = "m",
            .extent = "run",
            .meaning = "length of all axles; a made-up value",
            .value = [](const Run& run) { return 1.23456 * static_cast<double>(run.counts().entered); },
            .summary_decimals = 2,
            .sweep_decimals = 4,
            .console = {.heading = "all\naxles", .decimals = 1, .note = "a made-up length"}};
}

// Expects the metric of axle_metric() in all outputs of a list of metrics.
template <class Run>
void expect_everywhere(MetricList<Run> metrics, const Run& run) {
    metrics.push_back(axle_metric<Run>());

    const CsvTable summary = parse_csv(metrics_csv(metrics, run.scenario, std::vector<Run>{run}), "summary");
    EXPECT_EQ(summary.columns.back(), "axles_m");
    EXPECT_EQ(summary.rows.at(0).back(), "8.64");

    EXPECT_EQ(sweep_column_names(metrics, run.scenario).back(), "axles_m");
    EXPECT_EQ(sweep_metrics(metrics, run).back().column, "axles_m");
    EXPECT_EQ(sweep_metrics(metrics, run).back().value, "8.6419");

    std::vector<std::string> console;
    for (const auto& row : console_rows(metrics, run.scenario, std::vector<Run>{run})) console.push_back(row.back());
    EXPECT_EQ(console, (std::vector<std::string>{"all", "axles", "m", "8.6"}));
    EXPECT_EQ(console_notes(metrics, run.scenario).back(), "all axles: a made-up length");

    const std::string row = "| `axles_m` | m | run | length of all axles; a made-up value |\n";
    for (const auto& columns : {summary_columns(metrics, nullptr), sweep_columns(metrics, nullptr)}) {
        const std::string page = table_markdown({"table.csv", "", metric_docs(columns)});
        EXPECT_NE(page.find(row), std::string::npos) << page;
    }

    const ListedMetric listed = listed_metrics(metrics, nullptr).back();
    EXPECT_EQ(listed.column + " " + listed.unit + " " + listed.meaning, "axles_m m length of all axles");
}

TEST(NewMetric, OfASingleLightAppearsEverywhere) {
    const Scenario scenario = short_scenario();
    PopulationSummary summary;
    summary.passed.resize(scenario.measure.green_s.size());
    RunResult run;
    run.vehicles_entered = 7;
    expect_everywhere(single_light_metrics(), MeasuredLight{scenario, summary, run});
}

// A metric of each green time is a column of improvement.csv and a numbered column of sweeps.
TEST(NewMetric, OfAGreenTimeAppearsEverywhere) {
    SingleLightReport report;
    report.scenario = short_scenario();
    report.populations.resize(1);
    report.populations[0].name = "CDG";
    report.populations[0].passed = {3, 6, 9};
    report.populations[0].improvement_percent = {0.0, 0.0, 0.0};
    MetricList<MeasuredGreen> metrics = green_metrics();
    metrics.push_back({.column = "axles_m",
                       .unit = "m",
                       .extent = "green",
                       .meaning = "axles that pass within GREEN",
                       .value = [](const MeasuredGreen& run) { return 0.5 * run.summary.passed[run.green]; },
                       .summary_decimals = 1,
                       .sweep_decimals = 2});
    const CsvTable table = parse_csv(metrics_csv(metrics, report.scenario, measured_greens(report)), "improvement");
    EXPECT_EQ(table.columns.back(), "axles_m");
    ASSERT_EQ(table.rows.size(), 3U);
    EXPECT_EQ(table.rows[1].back(), "3.0");

    const MetricList<MeasuredLight> numbered = numbered_green_metrics(metrics);
    const RunResult run;
    const std::vector<RunMetric> in_sweep =
        sweep_metrics(numbered, MeasuredLight{report.scenario, report.populations[0], run});
    ASSERT_EQ(in_sweep.size(), 6U);
    EXPECT_EQ(in_sweep[0].column + " " + in_sweep[0].value, "passed_1_veh 3");
    EXPECT_EQ(in_sweep.back().column + " " + in_sweep.back().value, "axles_3_m 4.50");
    EXPECT_EQ(metric_docs(sweep_columns(numbered, nullptr)).back().meaning,
              "axles that pass within green time number K of `measure.green`");
}

TEST(NewMetric, OfAnIntersectionAppearsEverywhere) {
    const Scenario scenario = shipped("intersection.yaml");
    const IntersectionResult result = intersection_result(scenario);
    expect_everywhere(intersection_metrics(), MeasuredIntersection{scenario, result});
}

TEST(NewMetric, OfANetworkAppearsEverywhere) {
    const Scenario scenario = shipped("grid.yaml");
    const NetworkResult result = network_result();
    expect_everywhere(network_metrics(), MeasuredNetwork{scenario, result});
}

std::vector<std::string> wheel_names(const Scenario&) { return {"front", "rear_left"}; }
constexpr MetricFamily kWheels{"WHEEL", wheel_names};

// One entry of a family gives a column for each key. Neighbours of the same family alternate.
TEST(NewFamily, GivesAColumnForEachKey) {
    const Scenario scenario = shipped("grid.yaml");
    const NetworkResult result = network_result();
    const MeasuredNetwork run{scenario, result};
    const auto value = [](const MeasuredNetwork& of_key) { return of_key.key; };
    const MetricList<MeasuredNetwork> metrics{
        {.column = "radius_WHEEL_m",
         .meaning = "radius of WHEEL",
         .value = value,
         .family = &kWheels,
         .console = {.heading = "WHEEL", .begins_part = true}},
        {.column = "width_WHEEL_m", .meaning = "width", .value = value, .family = &kWheels}};
    EXPECT_EQ(metrics_csv(metrics, scenario, std::vector{run}),
              "population,radius_front_m,width_front_m,radius_rear_left_m,width_rear_left_m\nCDG,0,0,1,1\n");
    EXPECT_EQ(metric_docs(summary_columns(metrics, nullptr)).size(), 2U);
    EXPECT_EQ(metric_docs(summary_columns(metrics, nullptr))[0].name, "radius_WHEEL_m");
    EXPECT_EQ(metric_docs(summary_columns(metrics, &scenario))[2].meaning, "radius of rear_left");
    EXPECT_EQ(
        console_rows(metrics, scenario, std::vector{run}),
        (std::vector<std::vector<std::string>>{
            {"", "|", "", "rear"}, {"", "|", "front", "left"}, {"population", "|", "", ""}, {"CDG", "|", "0", "1"}}));
}

TEST(NewMetric, CanHaveAnotherPlaceInSweeps) {
    const auto entry = [](const char* column, const char* after) {
        return Metric<MeasuredNetwork>{
            .column = column, .value = [](const MeasuredNetwork&) { return 0; }, .sweep_after = after};
    };
    const MetricList<MeasuredNetwork> metrics{entry("last", "first"), entry("first", ""), entry("second", "")};
    const Scenario scenario = shipped("grid.yaml");
    EXPECT_EQ(sweep_column_names(metrics, scenario), (std::vector<std::string>{"first", "last", "second"}));
}

TEST(NewMetric, IsOnlyForItsKindOfNetwork) {
    Metric<MeasuredNetwork> metric = axle_metric<MeasuredNetwork>();
    metric.only_for = &NetworkKind::reports_approaches;
    EXPECT_TRUE(sweep_column_names(MetricList<MeasuredNetwork>{metric}, shipped("grid.yaml")).empty());
    EXPECT_EQ(sweep_column_names(MetricList<MeasuredNetwork>{metric}, shipped("berlin.yaml")).size(), 1U);
}

TEST(MetricValue, IsACell) {
    EXPECT_EQ(MetricValue(1.25).csv_cell(1), "1.2");
    EXPECT_EQ(MetricValue(std::nan("")).csv_cell(1), "");
    EXPECT_EQ(MetricValue(std::int64_t{-3}).csv_cell(1), "-3");
    EXPECT_EQ(MetricValue("stable").csv_cell(1), "stable");
    EXPECT_EQ(MetricValue(std::nan("")).console_cell(1, true), "-");
    EXPECT_EQ(MetricValue(2.0).console_cell(1, true), "+2.0");
    EXPECT_EQ(MetricValue(2).console_cell(1, true), "2");
}

// Columns end with the unit of their entry, unless they are counts.
const char* suffix_of(std::string_view unit) {
    const std::map<std::string_view, const char*> suffixes{{"s", "_s"},
                                                           {"m", "_m"},
                                                           {"%", "_percent"},
                                                           {"veh/h", "_veh_h"},
                                                           {"veh h", "_h"},
                                                           {"m/s", "_mps"},
                                                           {"m/s3", "_mps3"},
                                                           {"1/(veh km)", "_per_veh_km"},
                                                           {"g/veh", "_g_per_veh"},
                                                           {"g/km", "_g_per_km"},
                                                           {"g/stop", "_g_per_stop"},
                                                           {"l/100 km", "_l_per_100km"},
                                                           {"Wh/veh", "_Wh_per_veh"},
                                                           {"Wh/km", "_Wh_per_km"},
                                                           {"Wh/stop", "_Wh_per_stop"},
                                                           {"s/veh", "_s_per_veh"},
                                                           {"veh", ""},
                                                           {"", ""}};
    const auto found = suffixes.find(unit);
    return found == suffixes.end() ? "_?" : found->second;
}

template <class Run>
void expect_consistent(const MetricList<Run>& metrics) {
    for (const Metric<Run>& metric : metrics) {
        EXPECT_TRUE(metric.column.ends_with(suffix_of(metric.unit))) << metric.column << ' ' << metric.unit;
        const bool is_described = !metric.meaning.empty() || (metric.family && !metric.family->described.empty());
        EXPECT_TRUE(is_described || !(metric.in_summary() || metric.in_sweeps())) << metric.column;
        const auto is_named = [&](const Metric<Run>& other) { return other.column == metric.sweep_after; };
        EXPECT_TRUE(metric.sweep_after.empty() || std::any_of(metrics.begin(), metrics.end(), is_named))
            << metric.column << ": there is no column " << metric.sweep_after;
        const std::string_view placeholder = metric.family ? metric.family->placeholder : "";
        EXPECT_NE(metric.column.find(placeholder), std::string_view::npos) << metric.column;
    }
}

TEST(EveryMetric, IsConsistent) {
    expect_consistent(single_light_metrics());
    expect_consistent(intersection_metrics());
    expect_consistent(network_metrics());
}

TEST(EveryMetric, HasAMeanExceptForTheWorkAndTheWarmUp) {
    EXPECT_FALSE(has_mean("updates"));
    EXPECT_FALSE(has_mean("state_hash"));
    EXPECT_FALSE(has_mean("warm_up_s"));
    EXPECT_TRUE(has_mean("throughput_veh_h"));
    EXPECT_TRUE(has_mean("a column of the user"));
}

}  // namespace
}  // namespace stopline

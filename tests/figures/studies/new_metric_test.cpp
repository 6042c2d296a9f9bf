// One new entry is enough for a metric in the figures of sweeps. The figures read their metrics and axes from the table
// of metrics.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "figures/studies/lines.h"
#include "figures/studies/planes.h"
#include "figures/studies/surfaces.h"
#include "runs/metrics/metric_tables.h"
#include "runs/network/network_metrics.h"
#include "scenario/kinds/network_kind.h"

namespace stopline {
namespace {

const CsvTable& results() {
    static const CsvTable table = parse_csv(
        "green_s,offset_s,population,seed,throughput_veh_h,travel_time_s,density_percent,stability,axles_m\n"
        "5,0,CTG,1,1000,100,20,stable,4\n5,5,CTG,1,1000,100,20,stable,4\n8,0,CTG,1,1000,100,20,stable,4\n"
        "8,5,CTG,1,1000,100,20,stable,4\n5,0,CDG,1,1200,80,15,stable,5\n5,5,CDG,1,1200,80,15,stable,5\n"
        "8,0,CDG,1,1200,80,15,stable,5\n8,5,CDG,1,1200,80,15,stable,5\n",
        "by hand");
    return table;
}

MetricGroup with_axles() {
    MetricList<MeasuredNetwork> metrics = network_metrics();
    metrics.push_back(
        {.column = "axles_m",
         .unit = "m",
         .meaning = "a made-up value",
         .value = [](const MeasuredNetwork&) { return 4.0; },
         .figure = {.axis = "all axles", .sweep = {.change = "axles saved against {} [%]", .better = Better::lower}}});
    MetricGroup group = metric_group(kRunAsNetwork);
    group.drawn = drawn_metrics(metrics);
    return group;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(NewMetric, HasPanelsInTheFiguresOfSweeps) {
    const std::optional<SweepPlanes> planes = sweep_planes(results(), {}, "population", "CTG", {with_axles()});
    ASSERT_TRUE(planes);
    ASSERT_EQ(planes->metrics.size(), 4U);
    const Figure lines = sweep_lines_figure(*planes, planes->planes[0], 1);
    EXPECT_TRUE(contains(lines.body, "set multiplot layout 2,4"));
    EXPECT_TRUE(contains(lines.body, "set ylabel 'all axles [m]'"));
    EXPECT_TRUE(contains(lines.body, "set ylabel 'axles saved against CTG [%]'"));
    EXPECT_TRUE(contains(lines.data[0].second, "of throughput, travel time, density and all axles;"));
    EXPECT_TRUE(contains(lines.data[0].second, " 5 5 5 20 20 20 20 20 20 -25 -25 -25 -25 -25 -25\n"))
        << lines.data[0].second;
    const Figure surfaces = sweep_surfaces_figure(*planes, planes->planes[0], 1);
    EXPECT_TRUE(contains(surfaces.body, "CDG, all axles [m]"));
    EXPECT_GT(lines.width_px, sweep_lines_figure(*sweep_planes(results(), {}, "population", "CTG"), {}, 1).width_px);
}

TEST(NewMetric, IsNotDrawnWithoutItsColumn) {
    CsvTable others = results();
    others.columns.back() = "wheels_m";
    EXPECT_TRUE(sweep_metrics(others, "population", {with_axles()}).empty());
    EXPECT_EQ(sweep_metrics(others, "population").size(), 3U);
}

TEST(AxisTitle, ComesFromTheTableOfMetrics) {
    EXPECT_EQ(axis_title("throughput_veh_h"), "throughput [veh/h]");
    EXPECT_EQ(axis_title("travel_time_s"), "travel time [s]");
    EXPECT_EQ(axis_title("travel_time_94m_s"), "travel time, zone of 94 m [s]");
    EXPECT_EQ(axis_title("density_percent"), "density [%]");
    EXPECT_EQ(axis_title("teleported"), "teleported [veh]");
    EXPECT_EQ(axis_title("queue_veh"), "queue at the start of green [veh]");
    EXPECT_EQ(axis_title("delay_spillback_h"), "delay spillback [veh h]");
    EXPECT_EQ(axis_title("passed_2_veh"), "vehicles passed in green time 2 [veh]");
    EXPECT_EQ(axis_title("gridlocks"), "gridlocks");
    EXPECT_EQ(axis_title("a column of the user"), "a column of the user");
}

}  // namespace
}  // namespace stopline

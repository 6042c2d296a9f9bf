// This file registers a kind of network. Scenarios of this kind are loaded, run and reported, and lists name the kind.
#include "scenario/kinds/network_kind.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "runs/network/network.h"
#include "runs/run_metrics.h"
#include "runs/tables/column_docs.h"
#include "scenario/kinds/kind_parts.h"
#include "scenario/load_scenario.h"
#include "scenario/schema/fields.h"

namespace stopline {
namespace {

struct CrossroadsSettings {
    double leg_m = 150.0;
};

const Table& crossroads_table() {
    static const Table table = make_table<CrossroadsSettings>(
        "test: two roads that cross",
        {number<&CrossroadsSettings::leg_m>("leg", "m", {100, 1000}, "test: length of the legs")});
    return table;
}

LaneGraph crossroads(const NetworkSettings& network) {
    IntersectionSettings layout;
    layout.lanes = {{"straight+left"}, {"straight+right"}};
    layout.approach_length_m = layout.exit_length_m = own_settings<CrossroadsSettings>(network).leg_m;
    return make_intersection(layout);
}

const NetworkKind kCrossroadsKind{
    .name = "crossroads",
    .meaning = "test: two roads that cross",
    .run = kRunAsNetwork,
    .signal_groups = 2,
    .has_measured_area = true,
    .fields = [] { return std::vector{own_section<CrossroadsSettings>("crossroads", crossroads_table, "test")}; },
    .graph = crossroads,
    .add_signals =
        [](const Scenario& scenario, Model& model) {
            model.signals.add(make_signal_plan(
                scenario.signal, 0, make_stage_programmes(scenario.signal, 2, scenario.tick_s()), scenario.tick_s()));
        },
    .add_demand =
        [](const Scenario& scenario, Model& model) {
            add_drawn_demand(scenario, inlets_with_turn_shares(scenario, model.graph), 2, model);
        },
    .outer_legs =
        [](const NetworkSettings& network) {
            const double leg_m = own_settings<CrossroadsSettings>(network).leg_m;
            return std::vector<OuterLeg>{
                {"network.crossroads.leg", "network.crossroads.leg", 50.0 / 3.6, leg_m, leg_m}};
        },
    .highest_limit_mps = [](const NetworkSettings& /*network*/) { return 50.0 / 3.6; },
    .lane_width_m = [](const NetworkSettings& /*network*/) { return 3.5; },
    .check = check_signal_steps};

const bool kIsRegistered = (register_network_kind(kCrossroadsKind), true);

Scenario crossroads_with(std::vector<std::string> settings) {
    settings.insert(settings.begin(), {"network={kind: crossroads, crossroads: {leg: 120 m}}", "fidelity=meso",
                                       "populations=[CTG-Ref]", "duration=300 s"});
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml", settings);
}

std::string error_with(const std::vector<std::string>& settings) {
    try {
        crossroads_with(settings);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(NetworkKind, IsLoadedFromAScenario) {
    const Scenario scenario = crossroads_with({});
    EXPECT_EQ(own_settings<CrossroadsSettings>(scenario.network).leg_m, 120.0);
    const Scenario copy = scenario;
    EXPECT_EQ(own_settings<CrossroadsSettings>(copy.network).leg_m, 120.0);
    EXPECT_EQ(own_settings<CrossroadsSettings>(crossroads_with({"network={kind: crossroads}"}).network).leg_m, 150.0);
    EXPECT_NE(scenario.hash, crossroads_with({"network.crossroads.leg=130 m"}).hash);
}

TEST(NetworkKind, WrongFieldsAreRefused) {
    const auto expect_error = [](const std::vector<std::string>& settings, const std::string& part) {
        const std::string error = error_with(settings);
        EXPECT_NE(error.find(part), std::string::npos) << error;
    };
    expect_error({"network.kind=crosroads"}, "approach, intersection, grid, streets, sumo, crossroads");
    expect_error({"network.crossroads.leg=20 m"}, "100 m to 1000 m");
    expect_error({"network={kind: crossroads, grid: {rows: 2}}"}, "network.grid' applies only if kind is grid");
    expect_error({"network={kind: grid, crossroads: {leg: 120 m}}"}, "applies only if kind is crossroads");
    expect_error({"measure.area_margin=130 m"}, "at most 120 m, the value of network.crossroads.leg");
    expect_error({"measure.time_space=60 s"}, "is for grids and streets only");
    expect_error({"signal.green=10.05 s"}, "is not a whole number of steps");
}

TEST(NetworkKind, RunsAndReports) {
    const Scenario scenario = crossroads_with({});
    std::vector<std::string> columns;
    const std::vector<RunMetric> metrics = run_metrics(scenario, 0);
    for (const RunMetric& metric : metrics) {
        columns.push_back(metric.column);
        if (metric.column == "throughput_veh_h") {
            EXPECT_GT(std::stod(metric.value), 1000.0);
        }
        if (metric.column == "overlaps" || metric.column == "red_entries") {
            EXPECT_EQ(metric.value, "0");
        }
    }
    EXPECT_EQ(columns, result_columns(scenario));
    EXPECT_EQ(table_group(scenario.network), kRunAsNetwork);
    const std::string table = network_csv(run_networks(scenario, {}));
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 2);
    EXPECT_NE(table.find("\nCTG-Ref,"), std::string::npos);
}

TEST(NetworkKind, IsListed) {
    const std::string fields = describe_fields();
    EXPECT_NE(fields.find("crossroads"), std::string::npos);
    EXPECT_NE(fields.find("test: length of the legs"), std::string::npos);
}

}  // namespace
}  // namespace stopline

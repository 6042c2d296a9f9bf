// The kind `grid`: equal intersections in rows and columns.
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "network/lane_graph.h"
#include "scenario/kinds/kind_parts.h"
#include "scenario/network_checks.h"
#include "scenario/turn_checks.h"

namespace stopline {

namespace {

const Table& grid_table() {
    using S = GridSettings;
    static const Table table = make_table<S>(
        "a grid of equal intersections",
        {
            whole_number<&S::columns>("columns", {1, 200}, "number of streets that run from south to north"),
            whole_number<&S::rows>("rows", {1, 200}, "number of streets that run from west to east"),
            number<&S::column_spacing_m>("column_spacing", "m", {50, 10'000},
                                         "distance between intersection centres from west to east"),
            number<&S::row_spacing_m>("row_spacing", "m", {50, 10'000},
                                      "distance between intersection centres from south to north"),
            choice<&S::shape>(
                "shape", {"rectangle", "without_corners"},
                "without_corners: the four corner intersections are left out; 3 x 3 is then one intersection with four "
                "neighbours"),
        },
        [](const S& s, Checker& check) {
            if (!s.has_corners() && (s.columns < 3 || s.rows < 3)) {
                check.error("shape", "without_corners needs at least 3 columns and 3 rows");
            }
        });
    return table;
}

std::vector<Row<NetworkSettings>> grid_fields() {
    return {intersection_section(), section<&NetworkSettings::grid>("grid", grid_table, "arrangement of the grid")};
}

void add_grid_signals(const Scenario& scenario, Model& model) {
    const bool has_phases = scenario.signal.has_phases();
    const bool has_rings = find_signal_controller(scenario.signal.controller).runs_rings;
    const double cycle_s = has_rings    ? scenario.nominal_cycle().cycle_s
                           : has_phases ? first_cycle_s(scenario.signal)
                                        : scenario.signal.intersection_cycle_s();
    std::vector<double> first_green_s;
    for (const GridPosition& place : grid_positions(scenario.network.grid)) {
        // Whole cycles are removed from the offset, so that the initial red is as short as possible.
        first_green_s.push_back(scenario.signal.first_green_s +
                                std::fmod((place.column + place.row) * scenario.signal.offset_s, cycle_s));
    }
    if (has_phases) return add_phase_signals(scenario, first_green_s, model);
    for (const double start_s : first_green_s) {
        SignalSettings signal = scenario.signal;
        signal.first_green_s = start_s;
        model.signals.add(make_signal_plan(signal, model.signals.groups(),
                                           make_stage_programmes(signal, 2, scenario.tick_s()), scenario.tick_s()));
    }
}

void check_grid(const Scenario& scenario, Checker& check) {
    check_turn_shares(scenario, check);
    refuse_cycle(scenario, check);
    check_signal_steps(scenario, check);
    check_phases(scenario, check);
    check_first_green(scenario, check);
    check_grid_links(scenario, check);
}

// Returns the middle row or column. The names of its entry lanes begin with the name of the intersection at the border,
// unless the grid has only one intersection.
DiagramStreet middle_street(const NetworkSettings& network, const LaneGraph& /*graph*/, Side from) {
    const GridSettings& grid = network.grid;
    int column = grid.columns / 2;
    int row = grid.rows / 2;
    const bool along_row = from == Side::west || from == Side::east;
    const std::string title = along_row ? fmt::format("Row r{}", row) : fmt::format("Column c{}", column);
    if (from == Side::west) column = 0;
    if (from == Side::east) column = grid.columns - 1;
    if (from == Side::south) row = 0;
    if (from == Side::north) row = grid.rows - 1;
    const char* const side = kSideNames[static_cast<std::size_t>(from)];
    if (grid.columns == 1 && grid.rows == 1) return {fmt::format("{}_in_", side), title};
    return {fmt::format("c{}r{}_{}_in_", column, row, side), title};
}

}  // namespace

extern const NetworkKind kGridKind{
    .name = "grid",
    .meaning = "equal intersections in rows and columns",
    .run = kRunAsNetwork,
    .signal_groups = 2,
    .has_measured_area = true,
    .fields = grid_fields,
    .graph = [](const NetworkSettings& network) { return make_grid(network.grid, network.intersection); },
    .add_signals = add_grid_signals,
    .add_demand = add_intersection_demand,
    .outer_legs = intersection_legs,
    .highest_limit_mps = intersection_limit_mps,
    .lane_width_m = intersection_lane_width_m,
    .check = check_grid,
    .radius_beyond_m = intersection_radius_m,
    .add_detectors = add_counters,
    .diagram_street = middle_street};

}  // namespace stopline

// Parts that several kinds of networks share.
#pragma once

#include <string>
#include <vector>

#include "scenario/kinds/network_kind.h"

namespace stopline {

// --- Fields and layout --------------------------------------------------------------------------------------------

// The section `intersection`: the layout of an intersection, single or in a grid.
Row<NetworkSettings> intersection_section();
std::vector<OuterLeg> intersection_legs(const NetworkSettings& network);
double intersection_limit_mps(const NetworkSettings& network);
double intersection_lane_width_m(const NetworkSettings& network);
double intersection_radius_m(const NetworkSettings& network, const Lane& lane);

// --- Signals with phases --------------------------------------------------------------------------------------------

// Sets the signal groups of an intersection or a grid (assign_phase_groups()) and the right of way of the phases. Adds
// the signals, in the order of the intersections. `first_green_s`: start of the first phase of each intersection.
void add_phase_signals(const Scenario& scenario, const std::vector<double>& first_green_s, Model& model);
// Checks SignalSettings::phases and SignalSettings::programmes of an intersection or a grid. The names of movements
// must exist. Each movement must have green. No two protected movements of a phase may conflict.
void check_phases(const Scenario& scenario, Checker& check);
// Reports an error if the scenario sets phases. `network` describes the network in the message.
void refuse_phases(const Scenario& scenario, const std::string& network, Checker& check);

// --- Demand and detectors -----------------------------------------------------------------------------------------

// Adds the traffic of the section `demand`. `inlets`: one for each entry of the lane graph, then one for each link.
// `lanes`: number of lanes that share the arrival rate of an approach.
void add_drawn_demand(const Scenario& scenario, std::vector<DemandPlan::Inlet> inlets, int lanes, Model& model);
// Returns an inlet for each entry and each link, with the turn shares of the section `demand`.
std::vector<DemandPlan::Inlet> inlets_with_turn_shares(const Scenario& scenario, const LaneGraph& graph);
// Adds the traffic of an intersection or a grid.
void add_intersection_demand(const Scenario& scenario, Model& model);

// Adds detectors to a lane that begins at an intersection, that is, to a lane that is neither an entry lane nor a turn
// pocket: one detector a vehicle length after the start of the lane and, if the lane has a stop line, one in the
// middle.
void add_counters(const Scenario& scenario, int lane, Model& model);

// --- Checks -------------------------------------------------------------------------------------------------------

// Checks that a time is a whole number of steps. Signals, for instance, can change only between two steps.
void check_whole_steps(const Scenario& scenario, const std::string& field, double time_s, Checker& check);
// Checks that the times of the section `signal` and of measure.green are whole numbers of steps.
void check_signal_steps(const Scenario& scenario, Checker& check);
// Checks that the times of measure.green lie within the green and within the run.
void check_green_times(const Scenario& scenario, Checker& check);
// Checks that the first green lies within the run.
void check_first_green(const Scenario& scenario, Checker& check);
// Reports an error if the scenario sets signal.cycle. The cycle of an intersection is the sum of its stages.
void refuse_cycle(const Scenario& scenario, Checker& check);
// Report an error if the scenario sets signal.offset, which only grids use, or demand.cross_inflow, which only
// intersections and grids use.
void refuse_offset(const Scenario& scenario, Checker& check);
void refuse_cross_inflow(const Scenario& scenario, Checker& check);

}  // namespace stopline

#include "signal_timing/lane_demand.h"

#include <algorithm>
#include <cmath>

#include "base/containers/index.h"
#include "base/units.h"

namespace stopline {

namespace {

// Returns the flow that enters the network on each inlet, veh/h.
std::vector<double> entering_veh_h(const DemandPlan& demand) {
    std::vector<double> flows;
    for (std::size_t k = 0; k < demand.inlets.size(); ++k) {
        flows.push_back(demand.inlets[k].vehicles > 0 ? 3600.0 / demand.inlet_headway_s(static_cast<int>(k)) : 0.0);
    }
    return flows;
}

// Returns the index of the inlet on each lane; -1: the lane is not an inlet.
std::vector<int> inlet_of_lanes(const Model& model) {
    std::vector<int> inlet_of(model.graph.lanes.size(), -1);
    for (std::size_t k = 0; k < model.demand.inlets.size(); ++k) {
        inlet_of[at(model.demand.inlets[k].lane)] = static_cast<int>(k);
    }
    return inlet_of;
}

// Returns the flow of each inlet, veh/h. Repeats the balance of all inlets until it holds. It converges, because each
// vehicle reaches the border of the network.
std::vector<double> balanced_veh_h(const Model& model) {
    constexpr int kRounds = 100'000;
    constexpr double kClose_veh_h = 1e-9;
    const std::vector<double> own = entering_veh_h(model.demand);
    const std::vector<int> inlet_of = inlet_of_lanes(model);
    std::vector<double> flows = own;
    for (int round = 0; round < kRounds; ++round) {
        std::vector<double> next = own;
        for (std::size_t k = 0; k < flows.size(); ++k) {
            const DemandPlan::Inlet& inlet = model.demand.inlets[k];
            for (std::size_t i = 0; i < inlet.routes.size(); ++i) {
                const int to = inlet_of[at(model.graph.routes[at(inlet.routes[i])].lanes.back())];
                if (to >= 0) next[at(to)] += flows[k] * inlet.shares[i];
            }
        }
        double largest = 0.0;
        for (std::size_t k = 0; k < flows.size(); ++k) largest = std::max(largest, std::abs(next[k] - flows[k]));
        flows = std::move(next);
        if (largest < kClose_veh_h) break;
    }
    return flows;
}

}  // namespace

int stage_of_lane(const Lane& lane) { return lane.signal_group % kTimingStages; }

int index_of_lane(const Lane& lane) { return std::stoi(lane.name.substr(lane.name.rfind('_') + 1)); }

std::vector<LaneDemand> lane_demands(const Model& model) {
    const std::vector<double> flows = balanced_veh_h(model);
    std::vector<LaneDemand> demands;
    for (std::size_t k = 0; k < flows.size(); ++k) {
        const DemandPlan::Inlet& inlet = model.demand.inlets[k];
        const Lane& lane = model.graph.lanes[at(inlet.lane)];
        if (lane.signal_group < 0) continue;
        LaneDemand demand{lane.name, stage_of_lane(lane), index_of_lane(lane), flows[k]};
        for (std::size_t i = 0; i < inlet.routes.size(); ++i) {
            const Turn turn = model.graph.lanes[at(model.graph.routes[at(inlet.routes[i])].lanes[1])].turn;
            if (turn == Turn::left) demand.left_share += inlet.shares[i];
            if (turn == Turn::right) demand.right_share += inlet.shares[i];
        }
        demands.push_back(std::move(demand));
    }
    return demands;
}

}  // namespace stopline

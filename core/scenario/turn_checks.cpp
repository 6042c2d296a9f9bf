#include "scenario/turn_checks.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "scenario/schema/quantity.h"

namespace stopline {
namespace {

using LaneMovements = IntersectionSettings::LaneMovements;

// Shares of left and right turns, with the names of the demand fields that set them.
struct Shares {
    std::string left_field;
    double left = 0.0;
    std::string right_field;
    double right = 0.0;
};

bool allows_several(const LaneMovements& lane) { return lane.movements.find('+') != std::string::npos; }

// Reports an error for a turn share above 0 if no lane allows this turn together with another movement.
void check_served(const std::vector<LaneMovements>& lanes, const std::string& turn, const std::string& field,
                  double share, Checker& check) {
    const auto serves = [&](const LaneMovements& lane) { return allows_several(lane) && lane.allows(turn); };
    if (share == 0.0 || std::any_of(lanes.begin(), lanes.end(), serves)) return;
    check.error("demand." + field, "value " + short_text(share, unit("%")) +
                                       " has no effect: network.intersection.lanes has no lane that allows " + turn +
                                       " and another movement");
}

void check_lane(const LaneMovements& lane, const Shares& shares, Checker& check) {
    if (!lane.allows("left") || !lane.allows("right")) return;
    const std::string both = shares.left_field + " and " + shares.right_field;
    const double sum = shares.left + shares.right;
    if (sum > 1.0 + 1e-9) {
        check.error("demand." + shares.left_field, both + " sum to " + short_text(sum, unit("%")) + " on a lane '" +
                                                       lane.movements + "' (allowed: at most 100 %)");
    } else if (sum == 0.0 && !lane.allows("straight")) {
        check.error("demand." + shares.left_field, both + " are 0 %, but all vehicles turn on a lane '" +
                                                       lane.movements + "': one of them must be above 0 %");
    }
}

}  // namespace

void refuse_turns(const DemandSettings& demand, const std::string& network, Checker& check) {
    const auto refuse = [&](const std::string& field, bool used) {
        if (used) check.error("demand." + field, "has no effect on " + network);
    };
    refuse("right", demand.right_share != 0.0);
    refuse("left", demand.left_share != 0.0);
    refuse("cross_turns", demand.cross_turns != "same");
}

void check_turn_shares(const Scenario& scenario, Checker& check) {
    const DemandSettings& demand = scenario.demand;
    std::vector<Shares> all{{"left", demand.left_share, "right", demand.right_share}};
    if (demand.cross_turns == "separate") {
        all.push_back({"cross_left", demand.cross_left_share, "cross_right", demand.cross_right_share});
    }
    const std::vector<LaneMovements>& lanes = scenario.network.intersection.lanes;
    for (const Shares& shares : all) {
        check_served(lanes, "left", shares.left_field, shares.left, check);
        check_served(lanes, "right", shares.right_field, shares.right, check);
        for (const LaneMovements& lane : lanes) check_lane(lane, shares, check);
    }
}

}  // namespace stopline

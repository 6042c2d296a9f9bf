// Checks that the turn shares of the demand fit the movements that the lanes of the network allow.
#pragma once

#include <string>

#include "scenario/scenario.h"
#include "scenario/schema/report.h"

namespace stopline {

// Checks the turn shares of networks whose intersections have the layout network.intersection.
void check_turn_shares(const Scenario& scenario, Checker& check);
// Reports an error for each turn share that the demand sets. Call this function for a network in which turn shares have
// no effect. `network` describes the network in the message.
void refuse_turns(const DemandSettings& demand, const std::string& network, Checker& check);

}  // namespace stopline

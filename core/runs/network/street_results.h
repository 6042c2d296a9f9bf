// Results of networks of streets: inflow by side, congestion by approach, turn shares and lane changes (Section VII of
// the paper, Fig. 25 and 26).
#pragma once

#include <string>

#include "runs/network/network.h"

namespace stopline {

// These functions return the result tables as CSV text. scenarios/COLUMNS.md explains the columns.
std::string inflow_csv(const NetworkReport& report);
std::string approaches_csv(const NetworkReport& report);
std::string turns_csv(const NetworkReport& report);

}  // namespace stopline

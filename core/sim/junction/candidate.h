// A vehicle for which right of way is decided, and the result of the decision.
#pragma once

#include "sim/state/vehicles/vehicle_record.h"

namespace stopline {

struct Candidate {
    int slot;
    double front_m;  // front position along the connection; below 0: on the approach lane
    bool inside;     // the front is past the stop line
    bool stopped;    // slower than kCrawlingSpeed_mps (1 m/s)
};

inline constexpr double kNoWait_m = 1e9;  // stands for the waiting position of a vehicle that need not wait

// The position where a candidate must wait, and the vehicle for which it waits.
struct Wait {
    double place_m = kNoWait_m;  // waiting position along the connection; kNoWait_m: no wait
    int blocker = -1;            // slot of the vehicle for which the candidate waits; -1: none
    YieldReason reason = YieldReason::priority;
    // true: the candidate has accepted the gap behind the blocker, and keeps this gap while it waits until the blocker
    // has left the conflict area
    bool keeps_gap = false;

    bool exists() const { return place_m < kNoWait_m; }
};

}  // namespace stopline

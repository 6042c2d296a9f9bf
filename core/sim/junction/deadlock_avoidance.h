// Avoids deadlocks inside an intersection: keeps a vehicle out of a conflict area if it would stop across this area and
// thereby close a cycle of vehicles, each of which blocks the next one. No right of way can dissolve such a cycle.
//
// The vehicles of the cycle may still be driving. Each of them is in the area that it blocks, or can no longer stop
// before it. The vehicle that is the last one to reach this point would close the cycle, so it is the one that must
// stop. The positions where the others will stop, and their lengths, tell which areas they will block.
//
// This file is a part of the keep-clear rule and has no effect if that rule is off. It has no effect either if the
// pass-blocker rule is on, because that rule can dissolve such a cycle. driver/traffic_rules.h has both rules.
#pragma once

#include "sim/junction/candidate.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// A conflict area that a candidate must not enter yet.
struct KeptOutArea {
    double from_m = kNoWait_m;  // start of the area on the connection of the candidate; kNoWait_m: no such area
    int crossing_slot = -1;     // slot of the vehicle that must cross the area first

    bool exists() const { return from_m < kNoWait_m; }
};

// Returns the nearest conflict area ahead of `candidate` on connection `lane` whose entry would close a cycle:
//   - Further ahead, another vehicle is in the path of the candidate. The candidate would stop behind it with its body
//     across the area.
//   - A vehicle that must still cross the area is in the path of the other vehicle, directly or through further
//     vehicles. It can still stop before the area.
// A vehicle slower than kCrawlingSpeed_mps (1 m/s) is in the path of another one if it is in the conflict area of both.
// A faster vehicle must also stop there, because it waits for the next vehicle of the cycle. Ignores areas before which
// the candidate can no longer stop.
KeptOutArea area_to_keep_clear(const Model& model, const State& state, int lane, const Candidate& candidate);

}  // namespace stopline

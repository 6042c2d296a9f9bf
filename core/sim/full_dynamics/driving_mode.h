// Computes the driving mode of a vehicle (v2v/fallback.h). The mode of a step depends on the ages of the messages
// in all steps before. It is computed only in the steps in which it can change: when a message arrives, when the age of
// the newest message passes a limit, and when the hysteresis ends. The result equals that of an update in every step.
#pragma once

#include "v2v/plan.h"
#include "v2v/receiver.h"

namespace stopline {

struct AgeOfMessages {
    bool has_leader = false;
    int sent_tick = kNeverSent;  // tick at which the newest message of the leader was sent
};

// Updates the mode and its memory. `before`: up to the previous step; `now`: in this step. Returns the next tick
// at which the mode can change. Call at this tick, and in each step in which `now` differs from `before`.
int update_driving_mode(const V2vPlan& plan, int tick, const AgeOfMessages& before, const AgeOfMessages& now, int& mode,
                        V2vModeMemory& memory);

}  // namespace stopline

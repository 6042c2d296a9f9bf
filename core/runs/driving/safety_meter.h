// Measures comfort and surrogate safety of a run (measure.surrogate_safety). The meter samples the state every 0.1 s.
// It changes nothing. The leader of a vehicle is the vehicle ahead on its lane. The first vehicle of a lane has the
// leader that its perception finds beyond the lane, within the range of the radar. A leader that still merges into the
// path counts only when its rear is on the path, because right of way keeps the vehicles apart until then.
#pragma once

#include <cstdint>
#include <vector>

#include "runs/driving/safety_results.h"
#include "sim/state/state.h"

namespace stopline {

class SafetyMeter {
public:
    // The meter keeps a reference to the model.
    explicit SafetyMeter(const Model& model);

    // Call before each step, and once after the last step.
    void observe(const State& state);
    const SafetyResult& result() const { return result_; }

private:
    // The last samples of a vehicle.
    struct Track {
        std::int64_t last_tick = -1;  // -1: never seen
        double speed_mps = 0.0;
        double acceleration_mps2 = 0.0;  // mean between the last two samples; NaN: only one sample so far
        bool brakes_hard = false;
    };

    void observe(const State& state, int lane, int slot);
    void add_motion(Track& track, double speed_mps);
    void add_following(const State& state, int lane, int slot);

    const Model& model_;
    std::int64_t sample_ticks_ = 1;
    std::vector<Track> tracks_;  // [id]
    SafetyResult result_;
};

}  // namespace stopline

// One run: a Model (constant) and a State (all that changes), advanced a step at a time. The step is a list of named phases:
//
//   each part of the network by itself:
//     heads      what the first vehicle of each lane sees beyond it; overlaps with that    look_beyond.cpp, look_past.cpp
//     inside     who is on the way through an intersection                                 insiders.cpp
//     stops      who stops at which line, at red or since there is no room beyond it       stops.cpp
//     give way   who waits before which conflict area                                      right_of_way.cpp
//     gaps       who waits for a gap in the lane beside, or adapts its speed to one        wait_to_change.cpp
//   all together:
//     hindrance  who stands, what for, in whose way; now and then                          hindrance.cpp
//   each part of the network by itself again (move_vehicles.cpp):
//     plan       every vehicle's request, from the state at the beginning of the step      full_dynamics.cpp, meso_dynamics.cpp
//     move       powertrain, speed, position; overlaps on a lane are counted after it
//     detectors  fronts that passed one                                                    detectors.cpp
//   all together:
//     transfer   vehicles that passed the end of their lane                                transfer.cpp
//     insert     vehicles that enter                                                       entering.cpp, trips.cpp
//     move on    vehicles that have stood at the head of a lane for too long               moving_on.cpp
//     change     vehicles that change to the lane beside                                   lane_change.cpp
//     verify     nobody is lost; overlaps                                                  verify.cpp
//
// Parts are some whole intersections: as many as the second-level cache holds, or fewer, for each thread to have one. What is done in one depends on the state at the beginning of the step and on
// itself, so that results do not depend on how many there are.
#pragma once

#include <cstdint>

#include "sim/full_dynamics.h"
#include "sim/model.h"
#include "sim/sharing.h"
#include "sim/state.h"

namespace stopline {

class Simulation {
public:
    // Keeps a reference to the model, which must outlive the simulation. Throws InputError where it is not sound.
    // `threads`: that share the lanes of this run.
    explicit Simulation(const Model& model, int threads = 1);

    // From now on they share a step only while at least so many vehicles are there and that is faster (sharing.h), not always; nothing else
    // depends on it. Threads wait for each other several times a step, which costs more than they save where there is little to do.
    void share_from(int vehicles) {
        share_from_ = vehicles;
        shares_always_ = false;
    }

    void step();
    void run_until(double time_s);
    double time_s() const { return model_.time_s(state_.tick); }

    const State& state() const { return state_; }
    const Model& model() const { return model_; }

    // Hash over all vehicles in lane order and all counters. Equal hashes: equal to the last bit.
    std::uint64_t state_hash() const;

private:
    void step(bool shared);
    void decide(int thread, int threads);
    void decide(NetworkPart& part);
    void move(int thread, int threads);
    void move(NetworkPart& part);
    void share_watch();

    const Model& model_;
    FullTables tables_;
    State state_;
    int threads_;
    int share_from_ = 0;
    bool shares_always_ = true;
    Sharing sharing_;
};

}  // namespace stopline

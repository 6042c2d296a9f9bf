// One run: a constant Model, and a State that the simulation advances step by step. 'The phases of a step' in
// core/README.md lists the phases with their source files.
//
// A step first decides and then moves, for each partition (a group of whole intersections). The decisions read the
// state at the beginning of the step, and write only data of their partition. Results therefore do not depend on the
// number of partitions and threads.
#pragma once

#include <cstdint>

#include "sim/full_dynamics/full_dynamics.h"
#include "sim/performance/threading_heuristic.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

class Simulation {
public:
    // Keeps a reference to the model, which must outlive the simulation. `threads`: maximum number of threads for this
    // run. Throws InputError if the parts of the model contradict each other.
    explicit Simulation(const Model& model, int threads = 1);

    // Uses several threads only while at least `vehicles` vehicles are present and several threads are faster
    // (ThreadingHeuristic). Without this call the simulation always uses all threads. In small networks synchronisation
    // costs more than threads save. Results are the same in all cases.
    void use_threads_from(int vehicles) {
        threads_from_vehicles_ = vehicles;
        always_uses_threads_ = false;
    }

    // Limits the acceleration of one vehicle in all later steps. `vehicle` is its id; -1 ends the limit.
    void prescribe(const PrescribedAcceleration& prescribed) { state_.prescribed = prescribed; }

    // Sets the acceleration of a vehicle in all later steps (ExternalRequests). NaN: the gap law applies again. Throws
    // std::invalid_argument in the mesoscale mode.
    void request_acceleration(int vehicle, double acceleration_mps2);
    // Changes the spacing policy of a vehicle. Returns false if the vehicle is not in the network. `policy`: index in
    // Model::policies. Throws std::invalid_argument if its vehicle type or driver differs from the present one.
    bool set_policy(int vehicle, int policy);
    // Asks a signal with the controller `external` for a phase (signals/external.h).
    void request_phase(std::size_t signal, int phase);

    // Runs all phases of one step.
    void step();
    // Runs steps up to a time, then counts the lost vehicles (Violations::lost_vehicles).
    void run_until(double time_s);
    double time_s() const { return model_.time_s(state_.tick); }

    const State& state() const { return state_; }
    const Model& model() const { return model_; }

    // Returns a hash of the vehicles in lane order, of the recorded passages, of the tick, of the numbers of vehicles
    // that entered and exited, and of the signals whose controller reacts to traffic. Compare the hashes of two runs to
    // check that the results agree in every bit.
    std::uint64_t state_hash() const;

private:
    void step(bool use_threads);
    void decide(int thread, int threads);
    void decide(Partition& part);
    void move(int thread, int threads);
    void move(Partition& part);
    void watch_delays_in_parallel();

    const Model& model_;
    FullTables tables_;
    State state_;
    int threads_;
    int threads_from_vehicles_ = 0;
    bool always_uses_threads_ = true;
    ThreadingHeuristic heuristic_;
};

}  // namespace stopline

// A sweep over the ranks of `mpirun -n R stopline-sweep FILE`. Rank 0 owns the store and assigns points one at a time;
// the other ranks, the workers, run them. Without MPI or mpirun there is one rank.
//
// Rank 0 runs no point itself, because workers would have to wait for its answers. If a worker dies, plain mpirun ends
// the job; finished runs are stored and the same command continues. Under `mpirun --enable-recovery` the other workers
// go on: a worker that is silent for too long counts as dead, and its point is assigned again.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "sweeps/sweep_run.h"

namespace stopline {

class Ranks {
public:
    Ranks();
    Ranks(const Ranks&) = delete;
    Ranks& operator=(const Ranks&) = delete;
    Ranks(Ranks&&) = delete;
    Ranks& operator=(Ranks&&) = delete;
    ~Ranks();

    int rank() const { return rank_; }
    int count() const { return count_; }

    // Compares `key` over all ranks. An empty key means that this rank has met an error. Returns true if all keys are
    // equal and not empty. Otherwise rank 0 throws InputError, unless its own key is empty.
    bool agree_on(const std::string& key) const;

    // On rank 0: does what run_points does, through the workers.
    SweepSession serve(const std::vector<std::size_t>& points, RunStore& store,
                       const std::function<bool(double)>& on_progress, double silence_max_s);
    // On a worker: runs the points that rank 0 assigns, until its stop message.
    void work(const Sweep& sweep) const;

    // Returns the number of workers that have died.
    int lost() const { return lost_; }
    // Ends the program if workers have died, because MPI cannot shut down in order without them. Call it last.
    void leave(int exit_code) const;

private:
    int rank_ = 0;
    int count_ = 1;
    int lost_ = 0;
    bool started_ = false;
};

}  // namespace stopline

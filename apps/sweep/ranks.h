// Distributes the runs of a sweep over the ranks of `mpirun -n R stopline-sweep FILE`. A point is the number of one
// run. Rank 0 owns the store of results and assigns points to the other ranks, the workers, one at a time. Without MPI
// or mpirun there is one rank.
//
// Rank 0 executes no run itself, because the workers would have to wait for new points until this run ends. If a worker
// dies, plain mpirun ends the job. The finished runs are stored, and the same command executes the remaining runs.
// Under `mpirun --enable-recovery` the other workers continue. Rank 0 then counts a worker as dead if it sends no
// message for too long, and assigns the point of the dead worker again.
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

    // Compares `key` over all ranks, which must all call this function. A rank passes an empty key if it has met an
    // error. Returns true if all keys are equal and not empty. Otherwise returns false, but on rank 0 throws InputError
    // if the key of rank 0 is not empty.
    bool agree_on(const std::string& key) const;

    // Must be called on rank 0. Lets the workers run the points, and stores the results. (Without MPI, run_points()
    // does the same with threads.) A worker counts as dead after `silence_max_s` without a message.
    SweepSession serve(const std::vector<std::size_t>& points, RunStore& store,
                       const std::function<bool(double)>& on_progress, double silence_max_s);
    // Must be called on a worker. Runs the points that rank 0 assigns, until rank 0 sends the stop message.
    void work(const Sweep& sweep) const;

    // Returns the number of workers that have died.
    int lost() const { return lost_; }
    // Ends the program if workers have died, because MPI cannot shut down normally without them. This must be the last
    // call.
    void leave(int exit_code) const;

private:
    int rank_ = 0;
    int count_ = 1;
    int lost_ = 0;
    bool started_ = false;
};

}  // namespace stopline

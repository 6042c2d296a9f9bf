// A sweep over the ranks of `mpirun -n R stopline-sweep FILE`: rank 0 owns the store and hands out points one at a time, the
// others run them. In a build without MPI, and in a program that mpirun has not started, there is one rank.
//
// Rank 0 computes nothing: it would answer late, and the others would wait. Where a rank dies, plain mpirun ends the job; all
// finished runs are in the store, and the same command continues. Under `mpirun --enable-recovery` the others go on: a rank
// that has been silent for too long counts as dead, and its run is handed out again.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "experiment/sweep_run.h"

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

    // All ranks say what they are about to run ("": nothing, an error). True where all agree; rank 0 throws InputError where
    // it is another that does not.
    bool agree(const std::string& key) const;

    // Rank 0: as run_points, by the other ranks.
    SweepSession serve(const std::vector<std::size_t>& points, RunStore& store,
                       const std::function<bool(double)>& on_progress, double silence_max_s);
    // The other ranks: runs what rank 0 hands out, until it has no more.
    void work(const Sweep& sweep) const;

    // Ranks that have died. MPI cannot end in order without them: to be called last, with the exit code of the program.
    int lost() const { return lost_; }
    void leave(int exit_code) const;

private:
    int rank_ = 0;
    int count_ = 1;
    int lost_ = 0;
    bool started_ = false;
};

}  // namespace stopline

// Runs several simulations side by side in threads and joins their progress.
#pragma once

#include <cstddef>
#include <functional>

namespace stopline {

// Calls work(run, report) for each run from 0 to runs - 1. A run calls report(share) with the share that it has done,
// and stops when it returns false. Throws the exception of the first run that failed, and Interrupted if the user
// stopped.
void run_side_by_side(std::size_t runs, int threads, const std::function<bool(double)>& on_progress,
                      const std::function<void(std::size_t, const std::function<bool(double)>&)>& work);

}  // namespace stopline

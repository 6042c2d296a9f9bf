// Runs several simulations at the same time in threads, and reports their mean progress.
#pragma once

#include <cstddef>
#include <functional>

namespace stopline {

// Calls work(run, report) for each run number from 0 to `runs` - 1, in up to `threads` threads. `work` must call
// report(share) with the completed share of its run, 0 .. 1, and must end when report() returns false. `on_progress`
// gets the mean of these shares over all runs, and returns false to stop all runs. If runs fail, throws the exception
// of the failed run with the lowest number. Throws Interrupted if `on_progress` has returned false.
void run_side_by_side(std::size_t runs, int threads, const std::function<bool(double)>& on_progress,
                      const std::function<void(std::size_t, const std::function<bool(double)>&)>& work);

}  // namespace stopline

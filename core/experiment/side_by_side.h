// Runs side by side in threads, with one progress for all.
#pragma once

#include <cstddef>
#include <functional>

namespace stopline {

// Calls work(run, tell) for runs 0 .. runs - 1. `tell` takes the share that a run has done and returns false once the user wants to
// stop. Throws Interrupted then, and what a run threw (the first in their order).
void run_side_by_side(std::size_t runs, int threads, const std::function<bool(double)>& on_progress,
                      const std::function<void(std::size_t, const std::function<bool(double)>&)>& work);

}  // namespace stopline

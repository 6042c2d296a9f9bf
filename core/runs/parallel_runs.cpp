#include "runs/parallel_runs.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <vector>

#include "runs/interrupted.h"

namespace stopline {

void run_side_by_side(std::size_t runs, int threads, const std::function<bool(double)>& on_progress,
                      const std::function<void(std::size_t, const std::function<bool(double)>&)>& work) {
    std::vector<std::exception_ptr> errors(runs);
    std::mutex mutex;
    std::vector<double> shares(runs, 0.0);
    std::atomic<bool> stopped = false;
    const auto report = [&](std::size_t run, double share) {
        const std::lock_guard lock(mutex);
        shares[run] = share;
        double sum = 0.0;
        for (const double run_share : shares) sum += run_share;
        if (!stopped && on_progress && !on_progress(sum / static_cast<double>(runs))) stopped = true;
        return !stopped;
    };
    const int team = std::clamp(threads, 1, std::max(static_cast<int>(runs), 1));
#pragma omp parallel for schedule(dynamic) num_threads(team)
    for (std::size_t k = 0; k < runs; ++k) {
        if (stopped) continue;
        try {
            work(k, [&, k](double share) { return report(k, share); });
            static_cast<void>(report(k, 1.0));
        } catch (...) {
            errors[k] = std::current_exception();
        }
    }
    for (const std::exception_ptr& error : errors) {
        if (error) std::rethrow_exception(error);
    }
    if (stopped) throw Interrupted();
}

}  // namespace stopline

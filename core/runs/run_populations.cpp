#include "runs/run_populations.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>

namespace stopline {

namespace {

// Collects the progress of runs in several threads and reports the mean progress.
class MeanProgress {
public:
    MeanProgress(std::size_t runs, const std::function<bool(double)>& report) : shares_(runs), report_(report) {}

    // Stores the progress of one run. Returns false if the user has asked to stop the runs.
    bool update(std::size_t run, double share) {
        const std::lock_guard lock(mutex_);
        shares_[run] = share;
        if (!stopped_ && report_) {
            double sum = 0.0;
            for (const double run_share : shares_) sum += run_share;
            stopped_ = !report_(sum / static_cast<double>(shares_.size()));
        }
        return !stopped_;
    }

    bool stopped() const { return stopped_; }

private:
    std::mutex mutex_;
    std::vector<double> shares_;
    const std::function<bool(double)>& report_;
    std::atomic<bool> stopped_ = false;
};

}  // namespace

std::vector<RunResult> run_populations(const Scenario& scenario, const RunAllOptions& options) {
    const std::size_t runs = scenario.populations.size();
    std::vector<RunResult> results(runs);
    std::vector<std::exception_ptr> errors(runs);
    MeanProgress progress(runs, options.on_progress);
#pragma omp parallel for schedule(dynamic) num_threads(std::max(1, options.threads))
    for (std::size_t k = 0; k < runs; ++k) {
        if (progress.stopped()) continue;
        try {
            RunOptions run;
            run.trajectory_interval_s = options.trajectory_interval_s;
            run.trajectory_from_s = options.trajectory_from_s;
            run.trajectory_until_s = options.trajectory_until_s;
            run.observation = options.observation;
            run.on_progress = [&progress, k](double share) { return progress.update(k, share); };
            results[k] = run_population(scenario, k, run);
            progress.update(k, 1.0);
        } catch (...) {
            errors[k] = std::current_exception();
        }
    }
    for (const std::exception_ptr& error : errors) {
        if (error) std::rethrow_exception(error);
    }
    if (progress.stopped()) throw Interrupted();
    return results;
}

}  // namespace stopline

#include "sweeps/sweep_run.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <new>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/nearest_name.h"
#include "runs/interrupted.h"
#include "sweeps/sweep_results.h"

namespace stopline {

namespace {

std::size_t index_of_population(const Scenario& scenario, const std::string& name) {
    const auto named = [&](const PopulationSettings& population) { return population.name == name; };
    const auto found = std::find_if(scenario.populations.begin(), scenario.populations.end(), named);
    // The constructor of Sweep has checked that the population exists.
    return static_cast<std::size_t>(found - scenario.populations.begin());
}

// Passes the results of several threads to one recorder. Stops all threads after an error, or if the user wants to
// stop.
class SharedRecorder {
public:
    explicit SharedRecorder(SweepRecorder& recorder) : recorder_(recorder) {}

    bool stopped() const { return stopped_; }

    bool keep_going() {
        const std::lock_guard lock(mutex_);
        if (!stopped_) stopped_ = !recorder_.keep_going();
        return !stopped_;
    }

    void record(std::size_t point, const PointResult& result) {
        const std::lock_guard lock(mutex_);
        if (error_) return;
        recorder_.record(point, result);
        stopped_ = stopped_ || recorder_.stopped();
    }

    void fail(std::exception_ptr error) {
        const std::lock_guard lock(mutex_);
        if (!error_) error_ = std::move(error);
        stopped_ = true;
    }

    void rethrow() const {
        if (error_) std::rethrow_exception(error_);
        if (stopped_) throw Interrupted();
    }

private:
    SweepRecorder& recorder_;
    std::mutex mutex_;
    std::atomic<bool> stopped_ = false;
    std::exception_ptr error_;
};

}  // namespace

PointResult PointRunner::run(std::size_t point, const std::function<bool()>& keep_going) {
    const std::size_t combination = sweep_.combination(point);
    if (combination_ != combination) {
        scenario_ = sweep_.scenario(combination);
        combination_ = combination;
    }
    scenario_.seed = sweep_.seed(point);
    try {
        const std::size_t population = index_of_population(scenario_, sweep_.population(point));
        const std::vector<RunMetric> metrics = run_(scenario_, population, keep_going);
        if (metrics.empty()) return {PointResult::State::interrupted, {}};
        return {PointResult::State::done, result_text(sweep_, point, metrics)};
    } catch (const std::bad_alloc&) {
        return {PointResult::State::failed, "out of memory"};
    } catch (const std::exception& error) {
        return {PointResult::State::failed, error.what()};
    }
}

void SweepRecorder::record(std::size_t point, const PointResult& result) {
    if (result.state == PointResult::State::interrupted) return;
    if (result.state == PointResult::State::failed) {
        session_.failures.push_back({point, result.text});
    } else {
        store_.put(point, result.text);
        ++session_.runs;
        session_.updates += count_in(result.text, "updates");
    }
    keep_going();
}

bool SweepRecorder::keep_going() {
    const std::size_t finished = session_.runs + session_.failures.size();
    if (!stopped_ && on_progress_) stopped_ = !on_progress_(static_cast<double>(finished) / static_cast<double>(todo_));
    return !stopped_;
}

SweepSession SweepRecorder::session() const {
    SweepSession session = session_;
    session.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    std::sort(session.failures.begin(), session.failures.end(),
              [](const SweepFailure& a, const SweepFailure& b) { return a.point < b.point; });
    return session;
}

std::vector<std::size_t> missing_points(const Sweep& sweep, const Shard& shard, const RunStore& store) {
    const std::vector<bool> done = store.done();
    std::vector<std::size_t> points;
    for (std::size_t point = 0; point < sweep.points(); ++point) {
        if (shard.has(point) && !done[point]) points.push_back(point);
    }
    return points;
}

SweepSession run_points(const Sweep& sweep, const std::vector<std::size_t>& points, RunStore& store,
                        const SweepRunOptions& options) {
    SweepRecorder recorder(store, points.size(), options.on_progress);
    SharedRecorder shared(recorder);
#pragma omp parallel num_threads(std::max(1, options.threads))
    {
        PointRunner runner(sweep, options.run);
#pragma omp for schedule(dynamic)
        for (const std::size_t point : points) {
            if (shared.stopped()) continue;
            try {
                const PointResult result = runner.run(point, [&shared] { return shared.keep_going(); });
                shared.record(point, result);
            } catch (...) {
                shared.fail(std::current_exception());
            }
        }
    }
    shared.rethrow();
    return recorder.session();
}

}  // namespace stopline

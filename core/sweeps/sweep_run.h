// Runs points of a sweep and stores each run as soon as it is finished. If a run fails, the others continue.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runs/run_metrics.h"
#include "sweeps/run_store.h"
#include "sweeps/sweep.h"

namespace stopline {

using RunFunction = std::vector<RunMetric> (*)(const Scenario&, std::size_t population, const std::function<bool()>&);

struct PointResult {
    enum class State { done, failed, interrupted };
    State state = State::done;
    std::string text;  // result_text, or the error message
};

// Runs points one after another in one thread. It keeps the scenario, because successive points mostly share it.
class PointRunner {
public:
    explicit PointRunner(const Sweep& sweep, RunFunction function = run_metrics) : sweep_(sweep), run_(function) {}

    // Runs one point. Throws InputError if the files of the scenario have changed, because that concerns all points.
    PointResult run(std::size_t point, const std::function<bool()>& keep_going);

private:
    const Sweep& sweep_;
    RunFunction run_;
    std::optional<std::size_t> combination_;
    Scenario scenario_;
};

struct SweepFailure {
    std::size_t point;
    std::string message;
};

// The runs that one call of the program has added to the store.
struct SweepSession {
    std::size_t runs = 0;
    std::int64_t updates = 0;
    double wall_s = 0.0;
    std::vector<SweepFailure> failures;  // in the order of the points
};

// Records results one at a time: in the store, the counts and the progress.
class SweepRecorder {
public:
    // `on_progress` takes the share done of `todo` runs and returns false to stop.
    SweepRecorder(RunStore& store, std::size_t todo, std::function<bool(double)> on_progress)
        : store_(store), todo_(todo), on_progress_(std::move(on_progress)), begin_(std::chrono::steady_clock::now()) {}

    void record(std::size_t point, const PointResult& result);
    // Reports the progress. Returns false once the user wants to stop.
    bool keep_going();
    bool stopped() const { return stopped_; }
    SweepSession session() const;

private:
    RunStore& store_;
    std::size_t todo_;
    std::function<bool(double)> on_progress_;
    std::chrono::steady_clock::time_point begin_;
    SweepSession session_;
    bool stopped_ = false;
};

struct SweepRunOptions {
    int threads = 1;
    std::function<bool(double)> on_progress;  // see SweepRecorder
    RunFunction run = run_metrics;
};

// Returns the points of a shard that the store does not hold yet.
std::vector<std::size_t> missing_points(const Sweep& sweep, const Shard& shard, const RunStore& store);

// Runs the points side by side in threads. Throws Interrupted if on_progress returns false, and the errors of the
// store.
SweepSession run_points(const Sweep& sweep, const std::vector<std::size_t>& points, RunStore& store,
                        const SweepRunOptions& options);

}  // namespace stopline

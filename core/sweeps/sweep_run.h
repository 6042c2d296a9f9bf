// Runs points of a sweep (see sweep.h) and stores each run as soon as it is finished. If a run fails, the other runs
// continue.
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

// A function such as run_metrics(), which runs one population and returns its metrics.
using RunFunction = std::vector<RunMetric> (*)(const Scenario&, std::size_t population, const std::function<bool()>&);

struct PointResult {
    enum class State { done, failed, interrupted };
    State state = State::done;
    std::string text;  // state `done`: result_text(); state `failed`: error message
};

// Runs points one after another in one thread. Keeps the loaded scenario, because successive points mostly have the
// same scenario.
class PointRunner {
public:
    explicit PointRunner(const Sweep& sweep, RunFunction function = run_metrics) : sweep_(sweep), run_(function) {}

    // Runs one point. Throws InputError if the files of the scenario have changed, because this concerns all points.
    // Any other error gives a result with the state `failed`.
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

// Summary of the runs of one call of run_points().
struct SweepSession {
    std::size_t runs = 0;                // number of runs added to the store
    std::int64_t updates = 0;            // number of vehicles in the network, summed over all steps of these runs
    double wall_s = 0.0;                 // wall-clock time
    std::vector<SweepFailure> failures;  // in the order of the points
};

// Stores the results of runs, counts them and reports the progress. Only one thread at a time may use a recorder.
class SweepRecorder {
public:
    // `todo` is the number of runs to do. `on_progress` gets the completed share of these runs, 0 .. 1, and returns
    // false to stop.
    SweepRecorder(RunStore& store, std::size_t todo, std::function<bool(double)> on_progress)
        : store_(store), todo_(todo), on_progress_(std::move(on_progress)), begin_(std::chrono::steady_clock::now()) {}

    void record(std::size_t point, const PointResult& result);
    // Reports the progress. Returns false if the user has asked to stop.
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
    std::function<bool(double)> on_progress;  // gets the completed share, 0 .. 1; returns false to stop
    RunFunction run = run_metrics;
};

// Returns the points of a shard that the store does not hold yet.
std::vector<std::size_t> missing_points(const Sweep& sweep, const Shard& shard, const RunStore& store);

// Runs the points in options.threads threads and stores their results. Throws Interrupted if on_progress returns false.
// Throws InputError if the store cannot be written or the files of the scenario have changed.
SweepSession run_points(const Sweep& sweep, const std::vector<std::size_t>& points, RunStore& store,
                        const SweepRunOptions& options);

}  // namespace stopline

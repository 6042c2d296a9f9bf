// Runs points of a sweep and puts each into the store the moment it is finished. A run that fails costs only itself.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiment/run_metrics.h"
#include "experiment/run_store.h"
#include "experiment/sweep.h"

namespace stopline {

using RunFunction = std::vector<RunMetric> (*)(const Scenario&, std::size_t population, const std::function<bool()>&);

struct PointResult {
    enum class State { done, failed, interrupted };
    State state = State::done;
    std::string text;  // result_text, or what went wrong
};

// Runs points one after another, for one thread. Successive points mostly share their scenario, which is kept.
class PointRunner {
public:
    explicit PointRunner(const Sweep& sweep, RunFunction function = run_metrics) : sweep_(sweep), run_(function) {}

    // Throws InputError where the scenario's files have changed, which concerns all points.
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

// What one session of a program has added to the store.
struct SweepSession {
    std::size_t runs = 0;
    std::int64_t updates = 0;
    double wall_s = 0.0;
    std::vector<SweepFailure> failures;  // in the order of the points
};

// Where results go, one at a time: into the store, the counts and the progress.
class SweepRecorder {
public:
    // `on_progress`: share done of `todo` runs; false stops the work.
    SweepRecorder(RunStore& store, std::size_t todo, std::function<bool(double)> on_progress)
        : store_(store), todo_(todo), on_progress_(std::move(on_progress)), begin_(std::chrono::steady_clock::now()) {}

    void record(std::size_t point, const PointResult& result);
    bool keep_going();  // shows the progress; false once the user wants to stop
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

// The points of a shard that the store does not have yet.
std::vector<std::size_t> points_to_do(const Sweep& sweep, const Shard& shard, const RunStore& store);

// Runs the points side by side in threads. Throws Interrupted where on_progress asked to stop, and what the store throws.
SweepSession run_points(const Sweep& sweep, const std::vector<std::size_t>& points, RunStore& store,
                        const SweepRunOptions& options);

}  // namespace stopline

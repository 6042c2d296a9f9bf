#include "calibration/detector_times.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "runs/intersection/intersection_run.h"
#include "scenario/build_model.h"
#include "sweeps/sweep_results.h"

namespace stopline {

namespace {

double end_time_s(const Scenario& scenario) {
    return scenario.duration_s == 0.0 ? measured_window(scenario).to_s : scenario.duration_s;
}

// Returns the number of vehicles that will enter. It is the largest integer if an inlet is saturated.
std::int64_t planned_vehicles(const Model& model) {
    std::int64_t all = 0;
    for (const DemandPlan::Inlet& inlet : model.demand.inlets) {
        if (inlet.vehicles == std::numeric_limits<std::int64_t>::max()) return inlet.vehicles;
        all += inlet.vehicles;
    }
    return all;
}

double quantile(const std::vector<double>& sorted, double share) {
    if (sorted.empty()) return 0.0;
    const auto last = static_cast<double>(sorted.size() - 1);
    return sorted[static_cast<std::size_t>(std::ceil(share * last))];
}

}  // namespace

std::string detector_name(const Model& model, std::size_t detector) {
    static constexpr std::array<const char*, 6> kKinds{"stop_line", "zone", "exit", "middle", "loop", "signal"};
    const Detector& d = model.detectors[detector];
    if (d.loop >= 0) return model.loop_names[at(d.loop)];
    const std::string zone = d.kind == Detector::Kind::zone ? fmt::format("_{}", d.zone) : "";
    return fmt::format("{} {}{}", model.graph.lanes[at(d.lane)].name, kKinds[static_cast<std::size_t>(d.kind)], zone);
}

DetectorRun run_detectors(const Scenario& scenario, const Model& model, const std::function<bool()>& keep_going) {
    constexpr std::int64_t kAskInterval_ticks = 1000;
    Simulation simulation(model);
    const State& state = simulation.state();
    const std::int64_t end = to_ticks(end_time_s(scenario), model.step_s);
    const std::int64_t planned = planned_vehicles(model);
    DetectorRun run;
    while (state.tick < end && state.records.exited < planned) {
        if (state.tick % kAskInterval_ticks == 0 && keep_going && !keep_going()) return run;
        simulation.step();
    }
    run.times.resize(model.detectors.size());
    for (const Crossing& crossing : state.records.crossings)
        run.times[at(crossing.detector)].push_back(crossing.time_s);
    run.violations = state.records.violations;
    run.updates = state.records.updates;
    run.complete = true;
    return run;
}

std::vector<RunMetric> detector_metrics(const Scenario& scenario, std::size_t population,
                                        const std::function<bool()>& keep_going) {
    const Model model = build_model(scenario, population);
    const DetectorRun run = run_detectors(scenario, model, keep_going);
    if (!run.complete) return {};
    std::vector<RunMetric> metrics;
    for (std::size_t k = 0; k < run.times.size(); ++k) {
        std::string text;
        for (const double time_s : run.times[k]) text += fmt::format("{}{:.4f}", text.empty() ? "" : " ", time_s);
        if (!text.empty()) metrics.push_back({detector_name(model, k), text});
    }
    const Violations& v = run.violations;
    metrics.push_back({"overlaps", std::to_string(v.overlaps + v.conflicts)});
    metrics.push_back({"red_entries", std::to_string(v.red_entries)});
    metrics.push_back({"lost_vehicles", std::to_string(v.lost_vehicles)});
    metrics.push_back({"updates", std::to_string(run.updates)});
    return metrics;
}

DetectorTimes parse_detector_times(const std::string& result, const Model& model) {
    DetectorTimes times(model.detectors.size());
    for (std::size_t k = 0; k < times.size(); ++k) {
        const std::string text = value_in(result, detector_name(model, k));
        const char* position = text.c_str();
        for (char* end = nullptr; *position != '\0'; position = end) times[k].push_back(std::strtod(position, &end));
    }
    return times;
}

int PairedTimes::unpaired_count() const {
    int sum = 0;
    for (const auto& [detector, count] : unpaired) sum += count;
    return sum;
}

PairedTimes pair_up(const DetectorTimes& reference, const DetectorTimes& other) {
    PairedTimes paired;
    for (std::size_t detector = 0; detector < reference.size(); ++detector) {
        const std::vector<double>& reference_s = reference[detector];
        const std::vector<double>& other_s = other[detector];
        const std::size_t common = std::min(reference_s.size(), other_s.size());
        const auto unpaired = static_cast<int>(std::max(reference_s.size(), other_s.size()) - common);
        if (unpaired > 0) paired.unpaired[static_cast<int>(detector)] = unpaired;
        for (std::size_t k = 0; k < common; ++k) {
            paired.pairs.push_back({static_cast<int>(detector), static_cast<int>(k), reference_s[k], other_s[k]});
        }
    }
    return paired;
}

Agreement agreement(std::span<const PermutationPairs> permutations, double limit_s) {
    Agreement total;
    std::vector<double> differences_s;
    std::size_t within = 0;
    for (const PermutationPairs& permutation : permutations) {
        total.unpaired += static_cast<std::size_t>(permutation.times->unpaired_count());
        for (const PassagePair& pair : permutation.times->pairs) {
            const double difference_s = std::abs(pair.difference_s());
            differences_s.push_back(difference_s);
            within += difference_s <= limit_s ? 1 : 0;
            // A signal without a cycle has a single green.
            const bool is_other_green = permutation.cycle_s > 0.0 && difference_s >= 0.5 * permutation.cycle_s;
            total.other_green += is_other_green ? 1 : 0;
        }
    }
    std::sort(differences_s.begin(), differences_s.end());
    total.pairs = differences_s.size();
    const auto passages = static_cast<double>(std::max<std::size_t>(total.pairs + total.unpaired, 1));
    total.within_share = static_cast<double>(within) / passages;
    total.median_s = quantile(differences_s, 0.5);
    total.p95_s = quantile(differences_s, 0.95);
    total.largest_s = differences_s.empty() ? 0.0 : differences_s.back();
    return total;
}

}  // namespace stopline

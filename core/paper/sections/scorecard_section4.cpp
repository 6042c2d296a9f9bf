// Section IV of the paper: the reference intersection (rows I01 to I13 of data/paper/targets.csv) and Table 1 of the
// paper (T01 to T48).
//
// Every number is the mean over six seeds, or fewer in a quick run. An improvement compares two such means. The
// population MIX of the paper (half of the vehicles have the policy CDG) has the name P50 in
// scenarios/intersection.yaml. Density is the percentage of the total lane length that vehicles occupy.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "paper/sections/scorecard_sections.h"
#include "runs/interrupted.h"
#include "runs/intersection/intersection_run.h"

namespace stopline {

namespace {

constexpr const char* kRuns = "intersection";
constexpr int kSeeds = 6;  // number of seeds of each combination if the experiment is not reduced
constexpr std::array kGreens_s{5, 10, 15, 20, 25, 30};
constexpr std::array<const char*, 3> kPopulations{"CTG-Ref", "P50", "CDG"};

// A combination of population, green time and turn shares.
struct Point {
    std::string population;
    int green_s = 0;
    int left = 0;   // share of left turns, percent
    int right = 0;  // share of right turns, percent

    std::string named(const char* quantity) const {
        return fmt::format("{} {} green={} left={} right={}", quantity, population, green_s, left, right);
    }
};

// Returns the combinations that the rows of Table 1 and of Fig. 9 need.
std::vector<Point> points() {
    std::vector<Point> all;
    for (const char* population : kPopulations) {
        for (const int green_s : kGreens_s) {
            for (const int left : {0, 5, 15, 30}) {
                for (const int right : {0, 10, 30}) {
                    const bool corner = (left == 0 || left == 30) && right != 10;
                    const bool density = green_s == 15 && population == std::string("CTG-Ref");
                    if (corner || density) all.push_back({population, green_s, left, right});
                }
            }
        }
    }
    return all;
}

std::size_t index_of(const Scenario& scenario, const std::string& population) {
    for (std::size_t k = 0; k < scenario.populations.size(); ++k) {
        if (scenario.populations[k].name == population) return k;
    }
    return 0;
}

using OnStep = std::function<bool(const Simulation&)>;

IntersectionResult run_point(const Scenario& scenario, const Point& point, int repetition, const OnStep& on_step) {
    Scenario own = scenario;
    own.signal.green_s = point.green_s;
    own.demand.left_share = 0.01 * point.left;
    own.demand.right_share = 0.01 * point.right;
    own.seed = scenario.seed + static_cast<std::uint64_t>(repetition);
    return run_intersection(own, index_of(scenario, point.population), on_step);
}

// Runs each combination with each seed. The result lists all seeds of the first combination, then all seeds of the
// second, and so on. Throws Interrupted if options.on_progress returns false.
std::vector<IntersectionResult> run_points(const Scenario& scenario, const std::vector<Point>& all, int seeds,
                                           const ScorecardOptions& options) {
    constexpr std::int64_t kAskInterval_ticks = 1000;
    const int runs = static_cast<int>(all.size()) * seeds;
    std::vector<IntersectionResult> results(static_cast<std::size_t>(runs));
    int done = 0;
    std::mutex mutex;
    std::atomic<bool> keep_going = true;
    const auto report_progress = [&](int finished) {
        const std::lock_guard lock(mutex);
        done += finished;
        if (keep_going && options.on_progress && !options.on_progress(static_cast<double>(done) / runs))
            keep_going = false;
        return keep_going.load();
    };
    const OnStep on_step = [&](const Simulation& simulation) {
        return simulation.state().tick % kAskInterval_ticks != 0 || report_progress(0);
    };
#pragma omp parallel for schedule(dynamic) num_threads(options.threads)
    for (int run = 0; run < runs; ++run) {
        if (!keep_going) continue;
        const Point& point = all[static_cast<std::size_t>(run / seeds)];
        results[static_cast<std::size_t>(run)] = run_point(scenario, point, run % seeds, on_step);
        static_cast<void>(report_progress(1));
    }
    if (!keep_going) throw Interrupted();
    return results;
}

struct Sum {
    double throughput = 0.0, travel_s = 0.0, density = 0.0, present = 0.0, violations = 0.0;
};

Measurements measure_intersection(const Scenario& scenario, const ScorecardOptions& options) {
    const std::vector<Point> all = points();
    const int seeds = options.reductions.repetitions("scenarios/intersection").value_or(kSeeds);
    const std::vector<IntersectionResult> results = run_points(scenario, all, seeds, options);
    Measurements measured;
    double present = 0.0;
    double violations = 0.0;
    for (std::size_t k = 0; k < all.size(); ++k) {
        Sum sum;
        for (std::size_t r = 0; r < static_cast<std::size_t>(seeds); ++r) {
            const IntersectionResult& f = results[k * static_cast<std::size_t>(seeds) + r];
            sum.throughput += f.throughput_veh_h / seeds;
            sum.travel_s += f.zones.at(0).travel_time_s / seeds;
            sum.density += 100.0 * f.occupied / seeds;
            sum.present += f.vehicles_present / seeds;
            const Violations& v = f.violations;
            sum.violations +=
                static_cast<double>(v.overlaps + v.conflicts + v.red_entries + std::abs(v.lost_vehicles) + v.deadlocks);
        }
        measured.set(all[k].named("throughput"), sum.throughput);
        measured.set(all[k].named("travel_time"), sum.travel_s);
        measured.set(all[k].named("density"), sum.density);
        present += sum.present / static_cast<double>(all.size());
        violations += sum.violations;
    }
    measured.set("vehicles_present", present);
    measured.set("violations", violations);
    return measured;
}

std::optional<Point> point_of(const std::string& condition) {
    const std::optional<TurnCondition> found = parse_turn_condition(condition);
    if (!found) return std::nullopt;
    return Point{found->population, static_cast<int>(found->green_s), static_cast<int>(found->left_percent),
                 static_cast<int>(found->right_percent)};
}

std::optional<Answer> value_at_point(const char* quantity, const Target& target, const Measurements& measured) {
    const std::optional<Point> point = point_of(target.condition);
    if (!point) return std::nullopt;
    const std::optional<double> value = measured.find(point->named(quantity));
    return value ? std::optional(number_answer(*value)) : std::nullopt;
}

std::optional<Answer> throughput(const Target& target, const Measurements& measured) {
    return value_at_point("throughput", target, measured);
}

std::optional<Answer> travel_time(const Target& target, const Measurements& measured) {
    return value_at_point("travel_time", target, measured);
}

// Returns the change of a quantity relative to CTG-Ref at the same green time and turn shares, percent.
std::optional<double> change(const char* quantity, const Target& target, const Measurements& measured) {
    std::optional<Point> point = point_of(target.condition);
    if (!point) return std::nullopt;
    const std::optional<double> ours = measured.find(point->named(quantity));
    point->population = "CTG-Ref";
    const std::optional<double> baseline = measured.find(point->named(quantity));
    if (!ours || !baseline) return std::nullopt;
    return 100.0 * (*ours / *baseline - 1.0);
}

std::optional<Answer> improvement(const Target& target, const Measurements& measured) {
    const std::optional<double> percent = change("throughput", target, measured);
    return percent ? std::optional(number_answer(*percent)) : std::nullopt;
}

std::optional<Answer> reduction(const Target& target, const Measurements& measured) {
    const std::optional<double> percent = change("travel_time", target, measured);
    return percent ? std::optional(number_answer(-*percent)) : std::nullopt;
}

std::optional<Answer> density(const Target& target, const Measurements& measured) {
    if (point_of(target.condition)) return value_at_point("density", target, measured);
    double low = 1e9;
    double high = -1e9;
    for (const auto& [name, value] : measured.values()) {
        if (!name.starts_with("density CTG-Ref green=15 ")) continue;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    if (low > high) return std::nullopt;
    return range_answer(low, high);
}

std::optional<Answer> superlinear(const Target& /*target*/, const Measurements& measured) {
    bool holds = true;
    std::string text;
    for (const int left : {0, 30}) {
        for (const int right : {0, 30}) {
            const auto at = [&](const char* population) {
                return measured.find(Point{population, 15, left, right}.named("throughput"));
            };
            if (!at("CDG") || !at("P50") || !at("CTG-Ref")) return std::nullopt;
            const double ratio = (*at("P50") - *at("CTG-Ref")) / (*at("CDG") - *at("CTG-Ref"));
            holds = holds && ratio < 0.5;
            text += fmt::format("{}{:.2f}", text.empty() ? "PIR " : ", ", ratio);
        }
    }
    return claim_answer(holds, text);
}

std::optional<Answer> present(const Target& /*target*/, const Measurements& measured) {
    const std::optional<double> value = measured.find("vehicles_present");
    return value ? std::optional(number_answer(*value)) : std::nullopt;
}

std::vector<RowJudge> rows() {
    std::vector<RowJudge> all{{"I01", kRuns, throughput},  {"I02", kRuns, throughput},  {"I03", kRuns, throughput},
                              {"I04", kRuns, throughput},  {"I05", kRuns, improvement}, {"I06", kRuns, travel_time},
                              {"I07", kRuns, travel_time}, {"I08", kRuns, reduction},   {"I09", kRuns, reduction},
                              {"I10", kRuns, density},     {"I11", kRuns, density},     {"I12", kRuns, superlinear},
                              {"I13", kRuns, present}};
    static const std::vector<std::string> kTable = [] {
        std::vector<std::string> ids;
        for (int k = 1; k <= 48; ++k) ids.push_back(fmt::format("T{:02}", k));
        return ids;
    }();
    for (const std::string& id : kTable) all.push_back({id.c_str(), kRuns, improvement});
    return all;
}

}  // namespace

std::span<const Experiment> section4_experiments() {
    static const std::array kExperiments{Experiment{kRuns, "intersection", true, measure_intersection}};
    return kExperiments;
}

std::span<const RowJudge> section4_rows() {
    static const std::vector<RowJudge> kRows = rows();
    return kRows;
}

}  // namespace stopline

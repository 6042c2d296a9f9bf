#include "signal_timing/timing_search.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/io/csv.h"
#include "base/nan.h"
#include "scenario/build_model.h"
#include "sim/insertion/insert_vehicles.h"
#include "sim/step/simulation.h"

namespace stopline {

namespace {

constexpr double kWarmUpShare = 0.25;   // of the run
constexpr double kDelaySample_s = 0.5;  // interval between two samples of the delay

bool has_several_intersections(const Scenario& scenario) {
    const GridSettings& grid = scenario.network.grid;
    return scenario.network.kind == "grid" && grid.columns * grid.rows > 1;
}

// Returns how many vehicles are delayed: the sum over all vehicles of 1 - speed / speed limit, and those that wait to
// enter the network.
double delayed_vehicles(const Model& model, const State& state) {
    auto delayed = static_cast<double>(insertion_backlog(model, state));
    const VehicleArrays& v = state.vehicles;
    for (std::size_t lane = 0; lane < model.graph.lanes.size(); ++lane) {
        const LaneBlock& block = state.blocks[lane];
        const double limit_mps = model.graph.lanes[lane].limit_mps;
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            delayed += std::max(1.0 - static_cast<double>(v.speed_mps[at(slot)]) / limit_mps, 0.0);
        }
    }
    return delayed;
}

std::vector<std::string> values_with_seconds(const std::vector<double>& values_s) {
    std::vector<std::string> values;
    for (const double value_s : values_s) values.push_back(fmt::format("{:g} s", value_s));
    return values;
}

SweepAxis axis_of_times(const char* name, const char* path, const std::vector<double>& values_s) {
    SweepAxis axis;
    axis.name = name;
    axis.paths = {path};
    axis.values = values_with_seconds(values_s);
    axis.place = "--search";
    axis.value_places.assign(axis.values.size(), "--search");
    return axis;
}

double number_in(const CsvTable& table, const std::vector<std::string>& row, const char* column) {
    const std::optional<double> number = parse_number(row[table.column(column)]);
    if (!number) throw std::logic_error(fmt::format("the column {} of a search has a cell without number", column));
    return *number;
}

}  // namespace

std::vector<RunMetric> timing_metrics(const Scenario& scenario, std::size_t population,
                                      const std::function<bool()>& keep_going) {
    constexpr std::int64_t kTicksPerReport = 1000;
    Scenario timed = scenario;
    if (timed.duration_s == 0.0) timed.duration_s = kSearchDuration_s;
    const double duration_s = timed.duration_s;
    const Model model = build_model(timed, population);
    Simulation simulation(model);
    const State& state = simulation.state();
    const std::int64_t end = to_ticks(duration_s, model.step_s);
    const std::int64_t begin = to_ticks(kWarmUpShare * duration_s, model.step_s);
    const std::int64_t sample_ticks = std::max<std::int64_t>(to_ticks(kDelaySample_s, model.step_s), 1);
    double delayed = 0.0;
    std::int64_t samples = 0;
    std::int64_t exited_before = 0;
    while (state.tick < end) {
        if (state.tick % kTicksPerReport == 0 && keep_going && !keep_going()) return {};
        if (state.tick == begin) exited_before = state.records.exited;
        if (state.tick >= begin && (state.tick - begin) % sample_ticks == 0) {
            delayed += delayed_vehicles(model, state);
            ++samples;
        }
        simulation.step();
    }
    simulation.run_until(duration_s);  // counts the lost vehicles
    const double window_s = model.time_s(end - begin);
    const auto exited = static_cast<double>(state.records.exited - exited_before);
    // Vehicle seconds of delay in the window over the vehicles that leave in it.
    const double delay_s = delayed / static_cast<double>(samples) * window_s / std::max(exited, 1.0);
    const Violations& violations = state.records.violations;
    return {{"delay_s", fixed(delay_s, 6)},
            {"throughput_veh_h", fixed(3600.0 * exited / window_s, 6)},
            {"backlog", fmt::format("{}", insertion_backlog(model, state))},
            {"overlaps", fmt::format("{}", violations.overlaps)},
            {"red_entries", fmt::format("{}", violations.red_entries)},
            {"lost_vehicles", fmt::format("{}", violations.lost_vehicles)},
            {"updates", fmt::format("{}", state.records.updates)},
            {"state_hash", fmt::format("{:016x}", simulation.state_hash())}};
}

std::vector<double> searched_greens_s(double start_s, double shortest_s, int count, double range) {
    std::vector<double> values_s{start_s};
    const int steps = std::max(count / 2, 1);
    for (int k = -steps; k <= steps; ++k) {
        const double ratio = std::pow(range, static_cast<double>(k) / steps);
        const double value_s = std::round(start_s * ratio);
        if (count > 1 && value_s >= shortest_s) values_s.push_back(value_s);
    }
    std::sort(values_s.begin(), values_s.end());
    values_s.erase(std::unique(values_s.begin(), values_s.end()), values_s.end());
    return values_s;
}

std::vector<double> searched_offsets_s(double start_s, double cycle_s, int count) {
    std::vector<double> values_s{start_s};
    for (int k = 0; k < count && count > 1; ++k) values_s.push_back(std::round(cycle_s * k / count));
    std::sort(values_s.begin(), values_s.end());
    values_s.erase(std::unique(values_s.begin(), values_s.end()), values_s.end());
    return values_s;
}

SweepSettings search_settings(const Scenario& scenario, const PopulationTiming& start, const SearchOptions& options,
                              const TimingOptions& timing) {
    const std::array<double, kTimingStages> shortest_s = shortest_greens_s(scenario, timing);
    SweepSettings settings;
    settings.name = "search_" + start.saturation.population;
    settings.file = "--search";
    settings.scenario = options.file;
    settings.repetitions = options.seeds;
    const SignalTimes& times = start.times;
    settings.axes.push_back(axis_of_times(
        "green", "signal.green", searched_greens_s(times.green_s[0], shortest_s[0], options.greens, options.range)));
    settings.axes.push_back(
        axis_of_times("cross_green", "signal.cross_green",
                      searched_greens_s(times.green_s[1], shortest_s[1], options.greens, options.range)));
    if (has_several_intersections(scenario)) {
        settings.axes.push_back(axis_of_times("offset", "signal.offset",
                                              searched_offsets_s(times.offset_s, start.cycle_s, options.offsets)));
    }
    SweepAxis populations;
    populations.name = "population";
    populations.populations = {start.saturation.population};
    populations.place = "--search";
    settings.axes.push_back(std::move(populations));
    return settings;
}

std::vector<std::string> search_overrides(const Scenario& scenario, const std::string& population,
                                          const SearchOptions& options) {
    const std::vector<std::string>& listed = options.populations_in_file;
    std::vector<std::string> own;
    if (std::find(listed.begin(), listed.end(), population) == listed.end()) {
        own = {fmt::format("populations=[{}]", population), fmt::format("measure.baseline={}", population)};
    }
    std::vector<std::string> replaced = timing_overrides(scenario, {});
    replaced.insert(replaced.end(), own.begin(), own.end());
    std::vector<std::string> overrides;
    for (const std::string& text : options.overrides) {
        const std::string path = text.substr(0, text.find('='));
        const auto sets_path = [&](const std::string& one) { return one.substr(0, one.find('=')) == path; };
        if (std::none_of(replaced.begin(), replaced.end(), sets_path)) overrides.push_back(text);
    }
    overrides.insert(overrides.end(), own.begin(), own.end());
    return overrides;
}

TimingSearch search_results(const Scenario& scenario, const std::string& csv, const PopulationTiming& start,
                            Objective objective) {
    const CsvTable table = parse_csv(csv, "search");
    TimingSearch search;
    search.population = start.saturation.population;
    search.objective = objective;
    std::map<std::array<double, 3>, std::size_t> known;
    for (const std::vector<std::string>& row : table.rows) {
        SignalTimes times;
        times.green_s = {number_in(table, row, "green_s"), number_in(table, row, "cross_green_s")};
        if (has_several_intersections(scenario)) times.offset_s = number_in(table, row, "offset_s");
        const auto [found, is_new] =
            known.try_emplace({times.green_s[0], times.green_s[1], times.offset_s}, search.all.size());
        if (is_new) {
            const double change_s = scenario.signal.yellow_s + scenario.signal.all_red_s;
            search.all.push_back({times, times.green_s[0] + times.green_s[1] + 2.0 * change_s, {}, {}});
            if (times == start.times) search.start = search.all.size() - 1;
        }
        SearchedTimes& one = search.all[found->second];
        one.delay_s.push_back(number_in(table, row, "delay_s"));
        one.throughput_veh_h.push_back(number_in(table, row, "throughput_veh_h"));
    }
    const double sign = objective == Objective::delay ? 1.0 : -1.0;
    for (std::size_t k = 0; k < search.all.size(); ++k) search.best.push_back(k);
    std::stable_sort(search.best.begin(), search.best.end(), [&](std::size_t a, std::size_t b) {
        return sign * mean_of(search.all[a].values(objective)) < sign * mean_of(search.all[b].values(objective));
    });
    return search;
}

MeanInterval mean_interval(const std::vector<double>& values) {
    MeanInterval result{mean_of(values), {kNan, kNan}};
    if (values.size() > 1) result.interval = confidence_interval(values, Band::student);
    return result;
}

MeanInterval difference_to_start(const TimingSearch& search, std::size_t setting) {
    const std::vector<double>& start = search.all[search.start].values(search.objective);
    std::vector<double> differences = search.all[setting].values(search.objective);
    for (std::size_t seed = 0; seed < differences.size(); ++seed) differences[seed] -= start[seed];
    return mean_interval(differences);
}

bool is_best_at_border(const TimingSearch& search, const std::array<double, kTimingStages>& shortest_s) {
    const SearchedTimes& best = search.all[search.best.front()];
    for (std::size_t stage = 0; stage < kTimingStages; ++stage) {
        const auto is_shorter = [&](const SearchedTimes& a, const SearchedTimes& b) {
            return a.times.green_s[stage] < b.times.green_s[stage];
        };
        const auto [low, high] = std::minmax_element(search.all.begin(), search.all.end(), is_shorter);
        const double green_s = best.times.green_s[stage];
        if (low->times.green_s[stage] == high->times.green_s[stage]) continue;
        if (green_s == high->times.green_s[stage]) return true;
        if (green_s == low->times.green_s[stage] && green_s > shortest_s[stage]) return true;
    }
    return false;
}

std::string search_csv(const std::vector<TimingSearch>& searches) {
    CsvWriter csv({"population", "green_s", "cross_green_s", "offset_s", "cycle_s", "runs", "delay_s",
                   "throughput_veh_h", "objective", "mean", "ci95_low", "ci95_high", "difference",
                   "difference_ci95_low", "difference_ci95_high", "is_start"});
    for (const TimingSearch& search : searches) {
        for (std::size_t k = 0; k < search.all.size(); ++k) {
            const SearchedTimes& one = search.all[k];
            const MeanInterval mean = mean_interval(one.values(search.objective));
            const MeanInterval difference = difference_to_start(search, k);
            csv.row({search.population, fixed(one.times.green_s[0], 2), fixed(one.times.green_s[1], 2),
                     fixed(one.times.offset_s, 2), fixed(one.cycle_s, 2), fmt::format("{}", one.delay_s.size()),
                     fixed(mean_of(one.delay_s), 4), fixed(mean_of(one.throughput_veh_h), 2),
                     search.objective == Objective::delay ? "delay_s" : "throughput_veh_h", fixed(mean.mean, 4),
                     fixed(mean.interval.low, 4), fixed(mean.interval.high, 4), fixed(difference.mean, 4),
                     fixed(difference.interval.low, 4), fixed(difference.interval.high, 4),
                     k == search.start ? "1" : "0"});
        }
    }
    return csv.text();
}

}  // namespace stopline

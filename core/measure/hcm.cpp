#include "measure/hcm.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>

#include "base/containers/index.h"
#include "base/nan.h"
#include "measure/signal_equations.h"

namespace stopline {

namespace {

constexpr double kSeconds = 3600.0;        // per hour
constexpr double kLongestHeadway_s = 4.0;  // between two vehicles of a discharging queue

// A cycle of a lane: one interval for each of its greens, or an interval without green.
using LaneCycle = std::span<const HcmInterval>;

// Returns the number of greens that end in the intervals.
std::size_t greens_in(std::span<const HcmInterval> intervals) {
    return static_cast<std::size_t>(std::count_if(intervals.begin(), intervals.end(), [](const HcmInterval& interval) {
        return interval.has_green() && !interval.green_goes_on;
    }));
}

// Returns the cycles that lie within the window and whose greens are all recorded.
std::vector<LaneCycle> cycles_within(const HcmRecord& record, const TimeWindow& window) {
    std::vector<LaneCycle> cycles;
    if (greens_in(record.intervals) == 0) return cycles;
    std::size_t most_greens = 0;
    for (auto first = record.intervals.begin(); first != record.intervals.end();) {
        const auto is_other = [&](const HcmInterval& i) { return i.cycle < 0 || i.cycle != first->cycle; };
        const auto last = std::find_if(std::next(first), record.intervals.end(), is_other);
        cycles.emplace_back(first, last);
        most_greens = std::max(most_greens, greens_in(cycles.back()));
        first = last;
    }
    // The record can begin within a cycle. It can also end within a cycle, before the last green of this cycle.
    if (!cycles.empty()) {
        const bool may_have_more = cycles.back().front().cycle == record.last_cycle;
        if (may_have_more && greens_in(cycles.back()) < most_greens) cycles.pop_back();
    }
    std::erase_if(cycles, [&](const LaneCycle& cycle) {
        const bool has_begun_before = cycle.front().cycle >= 0 && cycle.front().cycle == record.first_cycle;
        return has_begun_before || cycle.front().from_s < window.from_s || cycle.back().to_s > window.to_s;
    });
    return cycles;
}

// Measures the headways of a lane by its position in the queue.
LaneDischarge discharge_of(const LaneGraph& graph, const HcmRecord& record, const TimeWindow& window, double cycle_s) {
    const std::vector<Detector> line{{record.lane, graph.lanes[at(record.lane)].stop_line_m}};
    std::vector<Crossing> crossings;
    for (std::size_t k = 0; k < record.passages.size(); ++k) {
        crossings.push_back({record.passages[k].time_s, static_cast<int>(k), 0, 0, 0.0F, 0.0F});
    }
    const auto latest_green_s = [&](int /*group*/, double time_s) {
        const auto later = std::upper_bound(record.green_starts_s.begin(), record.green_starts_s.end(), time_s);
        return later == record.green_starts_s.begin() ? -1.0 : *std::prev(later);
    };
    // A vehicle that follows after a longer headway has joined the queue after its discharge.
    const auto is_in_queue = [&](int k) {
        const HcmPassage& passage = record.passages[at(k)];
        if (!passage.has_queued || k == 0) return passage.has_queued;
        const double previous_s = record.passages[at(k - 1)].time_s;
        const bool is_first = previous_s < latest_green_s(0, passage.time_s);
        return is_first || passage.time_s - previous_s <= kLongestHeadway_s;
    };
    return discharge(graph, line, crossings, window, latest_green_s, cycle_s, is_in_queue).lanes[0];
}

// Measures the mean time from the end of green to the last passage of a queued vehicle, over the greens for which the
// queue lasts. It is below 0 if the last vehicle passes before the end of green.
void measure_end_gain(std::span<const HcmInterval> intervals, const std::vector<HcmPassage>& passages, HcmRow& row) {
    // A queue whose last vehicle passes earlier than kLongestHeadway_s before the end of green was held by something
    // else, such as oncoming traffic.
    double sum_s = 0.0;
    auto passage = passages.begin();
    for (const HcmInterval& interval : intervals) {
        double last_s = -1.0;
        for (; passage != passages.end() && passage->time_s < interval.to_s; ++passage) {
            if (passage->time_s >= interval.green_from_s && passage->has_queued) last_s = passage->time_s;
        }
        if (!interval.is_used || last_s < interval.green_to_s - kLongestHeadway_s) continue;
        sum_s += last_s - interval.green_to_s;
        ++row.used_greens;
    }
    row.end_gain_s = row.used_greens > 0 ? sum_s / row.used_greens : 0.0;
}

// The queue of a cycle is the longest one of its intervals.
void measure_queues(const std::vector<LaneCycle>& cycles, HcmRow& row) {
    std::vector<double> back_veh;
    std::vector<double> back_m;
    int residual = 0;
    for (const LaneCycle& cycle : cycles) {
        back_veh.push_back(0.0);
        back_m.push_back(0.0);
        for (const HcmInterval& interval : cycle) {
            back_veh.back() = std::max<double>(back_veh.back(), interval.back_veh);
            back_m.back() = std::max(back_m.back(), interval.back_m);
            row.green_s += (interval.green_to_s - interval.green_from_s) / row.cycles;
        }
        residual += cycle.back().residual_veh > 0 ? 1 : 0;
    }
    row.back_50_veh = percentile(back_veh, 0.5);
    row.back_95_veh = percentile(back_veh, 0.95);
    row.back_50_m = percentile(back_m, 0.5);
    row.back_95_m = percentile(back_m, 0.95);
    row.residual_share = static_cast<double>(residual) / row.cycles;
}

// Measures one lane without its capacity, which can depend on the other lanes.
HcmRow measured_row(const LaneGraph& graph, const HcmRecord& record, const std::vector<LaneCycle>& cycles) {
    const std::span<const HcmInterval> intervals(cycles.front().begin(), cycles.back().end());
    HcmRow row;
    row.name = graph.lanes[at(record.lane)].name;
    row.approach = record.approach;
    row.intersection = record.intersection;
    row.has_endless_demand = record.has_endless_demand;
    const TimeWindow whole{intervals.front().from_s, intervals.back().to_s};
    row.cycles = static_cast<int>(cycles.size());
    row.cycle_s = whole.length_s() / row.cycles;
    row.greens_per_cycle = static_cast<double>(greens_in(intervals)) / row.cycles;
    row.has_several_greens =
        std::any_of(cycles.begin(), cycles.end(), [](const LaneCycle& cycle) { return greens_in(cycle) > 1; });
    measure_queues(cycles, row);
    row.discharge = discharge_of(graph, record, whole, row.cycle_s);
    measure_end_gain(intervals, record.passages, row);
    int passed = 0;
    for (const HcmPassage& passage : record.passages) {
        if (!whole.contains(passage.time_s)) continue;
        ++passed;
        row.control_delay_s += std::max(passage.delay_s, 0.0);
        row.stops += passage.stops;
    }
    row.control_delay_s = passed > 0 ? row.control_delay_s / passed : kNan;
    row.stops = passed > 0 ? row.stops / passed : kNan;
    // A teleported vehicle has arrived, too, although it does not pass. A vehicle that changes lanes arrives on its
    // last lane, so the sum of the lane that it leaves can be negative.
    int arrived = passed + intervals.back().present_veh - intervals.front().present_before_veh;
    for (const HcmInterval& interval : intervals) arrived += interval.teleported_veh;
    row.initial_queue_veh = intervals.front().residual_before_veh;
    row.passed_veh_h = kSeconds * passed / whole.length_s();
    row.volume_veh_h = kSeconds * std::max(arrived, 0) / whole.length_s();
    return row;
}

// Sums over the greens of all lanes.
struct GreenMeans {
    double headways_s = 0.0;
    double lost_s = 0.0;
    int saturated = 0;
    double gains_s = 0.0;
    int used = 0;

    void add(const HcmRow& row) {
        const int own = row.discharge.saturated_greens;
        if (own > 0) {
            headways_s += own * row.discharge.saturation_headway_s;
            lost_s += own * row.discharge.startup_lost_time_s;
            saturated += own;
        }
        gains_s += row.used_greens * row.end_gain_s;
        used += row.used_greens;
    }
};

// Sets saturation flow, lost time and end gain. Lanes with fewer than kMinGreens greens get the means of all lanes.
void set_saturation_flows(std::vector<HcmRow>& rows) {
    GreenMeans all;
    for (const HcmRow& row : rows) all.add(row);
    for (HcmRow& row : rows) {
        const bool is_own = row.discharge.saturated_greens >= kMinGreens;
        const double mean_headway_s = all.saturated > 0 ? all.headways_s / all.saturated : kNan;
        const double mean_lost_s = all.saturated > 0 ? all.lost_s / all.saturated : kNan;
        row.saturation_flow_veh_h = kSeconds / (is_own ? row.discharge.saturation_headway_s : mean_headway_s);
        // Late arrivals in short queues can make the sum of the first headways too small.
        const double lost_s = is_own ? row.discharge.startup_lost_time_s : mean_lost_s;
        row.startup_lost_time_s = std::isnan(lost_s) ? lost_s : std::max(lost_s, 0.0);
        if (row.used_greens >= kMinGreens) continue;
        row.end_gain_s = all.used >= kMinGreens ? all.gains_s / all.used : kEndGain_s;
    }
}

// Sets delay and back of queue by the formula.
void apply_delay_formula(HcmRow& row) {
    const double period_h = row.cycles * row.cycle_s / kSeconds;
    row.uniform_delay_s = uniform_delay_s(row.cycle_s, row.effective_green_s, row.saturation);
    row.incremental_delay_s = incremental_delay_s(row.saturation, row.capacity_veh_h, period_h);
    row.initial_queue_delay_s =
        initial_queue_delay_s(row.initial_queue_veh, row.volume_veh_h, row.capacity_veh_h, period_h);
    const BackOfQueue back{row.volume_veh_h,      row.capacity_veh_h,      row.cycle_s,
                           row.effective_green_s, row.incremental_delay_s, row.initial_queue_delay_s};
    constexpr double kNormal95 = 1.64;  // quantile of the normal distribution, as in HCM chapter 31
    row.formula_back_50_veh = back.percentile_veh(0.0);
    row.formula_back_95_veh = back.percentile_veh(kNormal95);
}

void apply_equations(HcmRow& row) {
    const double change_s = row.greens_per_cycle * (row.end_gain_s - row.startup_lost_time_s);
    row.effective_green_s = std::clamp(row.green_s + change_s, 0.0, row.cycle_s);
    row.capacity_veh_h = row.effective_green_s > 0.0
                             ? capacity_veh_h(row.saturation_flow_veh_h, row.effective_green_s, row.cycle_s)
                             : kNan;
    // Without saturated greens of its own, as with a permissive left turn, a lane whose queue never clears shows its
    // capacity by the vehicles that pass.
    constexpr double kNeverClears = 0.9;
    if (row.discharge.saturated_greens < kMinGreens && row.residual_share >= kNeverClears && row.passed_veh_h > 0.0) {
        row.capacity_veh_h = row.passed_veh_h;
        row.effective_green_s = row.capacity_veh_h * row.cycle_s / row.saturation_flow_veh_h;
    }
    row.saturation = row.volume_veh_h / row.capacity_veh_h;
    // The formulas hold for one red and one green in a cycle.
    if (row.has_several_greens) {
        for (double* value : {&row.uniform_delay_s, &row.incremental_delay_s, &row.initial_queue_delay_s,
                              &row.formula_back_50_veh, &row.formula_back_95_veh}) {
            *value = kNan;
        }
    } else {
        apply_delay_formula(row);
    }
    const bool has_residual_queues = row.residual_share >= 0.5;
    if (row.saturation > 1.0 || (row.has_endless_demand && has_residual_queues)) {
        row.state = HcmState::oversaturated;
    } else if (has_residual_queues) {
        row.state = HcmState::saturated;
    }
    const double saturation = row.state == HcmState::oversaturated ? std::max(row.saturation, 1.001) : row.saturation;
    if (!std::isnan(row.control_delay_s)) row.level = level_of_service(row.control_delay_s, saturation);
    if (!std::isnan(row.formula_delay_s())) row.formula_level = level_of_service(row.formula_delay_s(), saturation);
}

// Returns a row with the sums and means of lanes, weighted by the vehicles that pass. The level of service follows from
// the delay alone (HCM exhibit 19-8, note).
HcmRow total_of(const std::vector<const HcmRow*>& lanes, HcmRow::Scope scope, const std::string& name) {
    HcmRow total;
    total.scope = scope;
    total.name = name;
    total.approach = lanes.front()->approach;
    total.intersection = lanes.front()->intersection;
    total.cycles = lanes.front()->cycles;
    for (double* value :
         {&total.cycle_s, &total.green_s, &total.saturation_flow_veh_h, &total.startup_lost_time_s, &total.end_gain_s,
          &total.effective_green_s, &total.back_50_veh, &total.back_95_veh, &total.back_50_m, &total.back_95_m,
          &total.formula_back_50_veh, &total.formula_back_95_veh, &total.residual_share, &total.saturation}) {
        *value = kNan;
    }
    for (const HcmRow* lane : lanes) {
        total.capacity_veh_h += lane->capacity_veh_h;
        total.volume_veh_h += lane->volume_veh_h;
        total.passed_veh_h += lane->passed_veh_h;
        total.saturation = std::fmax(total.saturation, lane->saturation);  // ignores lanes without a value
        total.state = std::max(total.state, lane->state);
        if (lane->passed_veh_h == 0.0) continue;
        total.control_delay_s += lane->passed_veh_h * lane->control_delay_s;
        total.stops += lane->passed_veh_h * lane->stops;
        total.uniform_delay_s += lane->passed_veh_h * lane->uniform_delay_s;
        total.incremental_delay_s += lane->passed_veh_h * lane->incremental_delay_s;
        total.initial_queue_delay_s += lane->passed_veh_h * lane->initial_queue_delay_s;
    }
    for (double* value : {&total.control_delay_s, &total.stops, &total.uniform_delay_s, &total.incremental_delay_s,
                          &total.initial_queue_delay_s}) {
        *value /= total.passed_veh_h;  // NaN if no vehicle passes
    }
    if (!std::isnan(total.control_delay_s)) total.level = level_of_service(total.control_delay_s, 0.0);
    if (!std::isnan(total.formula_delay_s())) total.formula_level = level_of_service(total.formula_delay_s(), 0.0);
    return total;
}

// Appends a row for each name of an approach or intersection, in the order of the lanes.
void add_totals(std::size_t lanes, HcmRow::Scope scope, std::string HcmRow::*name, std::vector<HcmRow>& rows) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < lanes; ++k) {
        if (std::find(names.begin(), names.end(), rows[k].*name) == names.end()) names.push_back(rows[k].*name);
    }
    for (const std::string& one : names) {
        std::vector<const HcmRow*> members;
        for (std::size_t k = 0; k < lanes; ++k) {
            if (rows[k].*name == one) members.push_back(&rows[k]);
        }
        HcmRow total = total_of(members, scope, one);
        rows.push_back(std::move(total));
    }
}

}  // namespace

const char* hcm_state_name(HcmState state) {
    constexpr std::array<const char*, 3> kNames{"free", "saturated", "oversaturated"};
    return kNames[static_cast<std::size_t>(state)];
}

double percentile(std::vector<double> values, double share) {
    if (values.empty()) return kNan;
    std::sort(values.begin(), values.end());
    const double place = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

std::vector<HcmRow> hcm_rows(const LaneGraph& graph, const std::vector<HcmRecord>& records, const TimeWindow& window) {
    std::vector<HcmRow> rows;
    for (const HcmRecord& record : records) {
        const std::vector<LaneCycle> cycles = cycles_within(record, window);
        if (!cycles.empty()) rows.push_back(measured_row(graph, record, cycles));
    }
    set_saturation_flows(rows);
    for (HcmRow& row : rows) apply_equations(row);
    const std::size_t lanes = rows.size();
    add_totals(lanes, HcmRow::Scope::approach, &HcmRow::approach, rows);
    add_totals(lanes, HcmRow::Scope::intersection, &HcmRow::intersection, rows);
    return rows;
}

}  // namespace stopline

#include "measure/hcm.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "base/containers/index.h"
#include "base/nan.h"
#include "measure/signal_equations.h"

namespace stopline {

namespace {

constexpr double kSeconds = 3600.0;  // per hour

// Returns the cycles that lie within the window.
std::span<const HcmCycle> cycles_within(const HcmRecord& record, const TimeWindow& window) {
    const auto is_before = [&](const HcmCycle& cycle) { return cycle.from_s < window.from_s; };
    const auto first = std::find_if_not(record.cycles.begin(), record.cycles.end(), is_before);
    const auto last = std::find_if(first, record.cycles.end(), [&](const HcmCycle& c) { return c.to_s > window.to_s; });
    return {first, last};
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
    return discharge(graph, line, crossings, window, latest_green_s, cycle_s,
                     [&](int k) { return record.passages[at(k)].has_queued; })
        .lanes[0];
}

// Returns the mean time from the end of green to the last passage of a queued vehicle, over the greens for which the
// queue lasts. It is below 0 if the last vehicle passes before the end of green.
double end_gain_s(std::span<const HcmCycle> cycles, const std::vector<HcmPassage>& passages) {
    double sum_s = 0.0;
    int used = 0;
    for (const HcmCycle& cycle : cycles) {
        if (!cycle.is_used) continue;
        const HcmPassage* last = nullptr;
        for (const HcmPassage& passage : passages) {
            if (passage.time_s >= cycle.green_from_s && passage.time_s < cycle.to_s && passage.has_queued) {
                last = &passage;
            }
        }
        if (last == nullptr) continue;
        sum_s += last->time_s - cycle.green_to_s;
        ++used;
    }
    return used > 0 ? sum_s / used : kEndGain_s;
}

void measure_queues(std::span<const HcmCycle> cycles, HcmRow& row) {
    std::vector<double> back_veh;
    std::vector<double> back_m;
    int residual = 0;
    for (const HcmCycle& cycle : cycles) {
        back_veh.push_back(cycle.back_veh);
        back_m.push_back(cycle.back_m);
        residual += cycle.residual_veh > 0 ? 1 : 0;
        row.green_s += (cycle.green_to_s - cycle.green_from_s) / row.cycles;
    }
    row.back_50_veh = percentile(back_veh, 0.5);
    row.back_95_veh = percentile(back_veh, 0.95);
    row.back_50_m = percentile(back_m, 0.5);
    row.back_95_m = percentile(back_m, 0.95);
    row.residual_share = static_cast<double>(residual) / row.cycles;
}

// Measures one lane without its capacity, which can depend on the other lanes. `before` is the cycle before the first
// one; null: there is none.
HcmRow measured_row(const LaneGraph& graph, const HcmRecord& record, std::span<const HcmCycle> cycles) {
    HcmRow row;
    row.name = graph.lanes[at(record.lane)].name;
    row.approach = record.approach;
    row.intersection = record.intersection;
    row.has_endless_demand = record.has_endless_demand;
    const TimeWindow whole{cycles.front().from_s, cycles.back().to_s};
    row.cycles = static_cast<int>(cycles.size());
    row.cycle_s = whole.length_s() / row.cycles;
    measure_queues(cycles, row);
    row.discharge = discharge_of(graph, record, whole, row.cycle_s);
    row.end_gain_s = end_gain_s(cycles, record.passages);
    int passed = 0;
    for (const HcmPassage& passage : record.passages) {
        if (!whole.contains(passage.time_s)) continue;
        ++passed;
        row.control_delay_s += passage.delay_s;
        row.stops += passage.stops;
    }
    row.control_delay_s = passed > 0 ? row.control_delay_s / passed : kNan;
    row.stops = passed > 0 ? row.stops / passed : kNan;
    const HcmCycle* before = cycles.data() == record.cycles.data() ? nullptr : cycles.data() - 1;
    const int growth = before == nullptr ? 0 : cycles.back().present_veh - before->present_veh;
    row.initial_queue_veh = before == nullptr ? 0.0 : before->residual_veh;
    row.passed_veh_h = kSeconds * passed / whole.length_s();
    row.volume_veh_h = kSeconds * (passed + growth) / whole.length_s();
    return row;
}

// Sets saturation flow and lost time. Lanes without a saturated green get the means of the other lanes.
void set_saturation_flows(std::vector<HcmRow>& rows) {
    double headways_s = 0.0;
    double lost_s = 0.0;
    int greens = 0;
    for (const HcmRow& row : rows) {
        const int own = row.discharge.saturated_greens;
        if (own == 0) continue;
        headways_s += own * row.discharge.saturation_headway_s;
        lost_s += own * row.discharge.startup_lost_time_s;
        greens += own;
    }
    for (HcmRow& row : rows) {
        const bool is_own = row.discharge.saturated_greens > 0;
        const double headway_s = is_own ? row.discharge.saturation_headway_s : greens > 0 ? headways_s / greens : kNan;
        row.saturation_flow_veh_h = kSeconds / headway_s;
        row.startup_lost_time_s = is_own ? row.discharge.startup_lost_time_s : greens > 0 ? lost_s / greens : kNan;
    }
}

void apply_equations(HcmRow& row) {
    const double period_h = row.cycles * row.cycle_s / kSeconds;
    row.effective_green_s = std::clamp(row.green_s - row.startup_lost_time_s + row.end_gain_s, 0.0, row.cycle_s);
    row.capacity_veh_h = capacity_veh_h(row.saturation_flow_veh_h, row.effective_green_s, row.cycle_s);
    row.saturation = row.volume_veh_h / row.capacity_veh_h;
    row.uniform_delay_s = uniform_delay_s(row.cycle_s, row.effective_green_s, row.saturation);
    row.incremental_delay_s = incremental_delay_s(row.saturation, row.capacity_veh_h, period_h);
    row.initial_queue_delay_s =
        initial_queue_delay_s(row.initial_queue_veh, row.volume_veh_h, row.capacity_veh_h, period_h);
    const BackOfQueue back{row.volume_veh_h,      row.capacity_veh_h,      row.cycle_s,
                           row.effective_green_s, row.incremental_delay_s, row.initial_queue_delay_s};
    constexpr double kNormal95 = 1.64;  // quantile of the normal distribution, as in HCM chapter 31
    row.formula_back_50_veh = back.percentile_veh(0.0);
    row.formula_back_95_veh = back.percentile_veh(kNormal95);
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
          &total.formula_back_50_veh, &total.formula_back_95_veh, &total.residual_share}) {
        *value = kNan;
    }
    for (const HcmRow* lane : lanes) {
        total.capacity_veh_h += lane->capacity_veh_h;
        total.volume_veh_h += lane->volume_veh_h;
        total.passed_veh_h += lane->passed_veh_h;
        total.saturation = std::max(total.saturation, lane->saturation);
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
        const std::span<const HcmCycle> cycles = cycles_within(record, window);
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

#include "signals/timing_text.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "common/command_line.h"
#include "common/text_table.h"
#include "measure/signal_equations.h"
#include "scenario/schema/quantity.h"

namespace stopline {

namespace {

std::string level_text(double delay_s, double saturation) {
    return std::isnan(delay_s) ? "-" : std::string(1, level_of_service(delay_s, saturation));
}

std::string lanes_table(const std::vector<PopulationTiming>& timings) {
    TextTable table("lllrrrrrrrrl");
    table.add_row({"population", "street", "lane", "demand", "saturation", "flow ratio", "lost time", "green",
                   "degree of", "delay d1", "delay d2", "level of"});
    table.add_row({"", "", "", "veh/h", "flow veh/h", "", "s", "s", "saturation", "s", "s", "service"});
    for (const PopulationTiming& one : timings) {
        for (const LaneTiming& lane : one.lanes) {
            const std::size_t stage = at(lane.demand.stage);
            table.add_row({one.saturation.population, kTimingStreets[stage], lane.demand.lane,
                           number_cell(lane.demand.flow_veh_h, 0), number_cell(lane.saturation_flow_veh_h, 0),
                           number_cell(lane.flow_ratio, 3) + (lane.is_critical ? "*" : " "),
                           number_cell(one.lost_time_s[stage], 1), number_cell(one.times.green_s[stage], 0),
                           number_cell(lane.saturation, 2), number_cell(lane.uniform_delay_s, 1),
                           number_cell(lane.incremental_delay_s, 1), level_text(lane.delay_s(), lane.saturation)});
        }
    }
    return table.text();
}

std::string signals_table(const std::vector<PopulationTiming>& timings, bool shows_offset) {
    TextTable table("lrrrrrrrrl");
    table.add_row({"population", "flow ratios", "lost time", "Webster", "cycle", "green", "cross green", "offset",
                   "delay", "level of"});
    table.add_row({"", "sum", "s", "cycle s", "s", "s", "s", "s", "s", "service"});
    for (const PopulationTiming& one : timings) {
        table.add_row({one.saturation.population, number_cell(one.flow_ratio_sum, 3),
                       number_cell(one.lost_time_s[0] + one.lost_time_s[1], 1), number_cell(one.webster_cycle_s, 1),
                       number_cell(one.cycle_s, 0), number_cell(one.times.green_s[0], 0),
                       number_cell(one.times.green_s[1], 0), shows_offset ? number_cell(one.times.offset_s, 0) : "-",
                       number_cell(one.delay_s, 1), level_text(one.delay_s, one.highest_saturation())});
    }
    return table.text();
}

std::string assumptions_text(const std::vector<PopulationTiming>& timings, const Scenario& scenario, bool is_network) {
    std::vector<std::string> notes{
        "Saturation flow and lost times are measured in runs with saturated demand. The runs are repeated until the "
        "measured and the resulting greens agree. * marks the lane that determines the green."};
    const auto yields = [](const LaneSaturation& lane) { return lane.turns_left; };
    const auto has_left = [&](const PopulationTiming& one) {
        return std::any_of(one.saturation.lanes.begin(), one.saturation.lanes.end(), yields);
    };
    if (std::any_of(timings.begin(), timings.end(), has_left)) {
        notes.emplace_back(
            "Left turns yield to oncoming traffic. The flow of a lane with left turns is measured with a queue on its own "
            "leg, and with the demand on the oncoming leg. Its capacity changes from cycle to cycle. d2 includes the "
            "delay that this causes. The simulated delay of such a lane can still be much higher: add --search to "
            "check it.");
    }
    if (is_network) {
        notes.emplace_back(
            "All intersections have the same greens. Each row shows the lane with the most demand in the network. The "
            "offset lets vehicles at the speed limit meet green eastwards (in a single column, northwards). The "
            "predicted delay assumes arrivals without platoons.");
    }
    if (!scenario.demand.profile.empty()) {
        notes.emplace_back("The demand is that of the highest factor in demand.profile.");
    }
    std::string delays =
        "d1 is the delay of evenly spaced arrivals, d2 that of random arrivals (HCM 2000, equations 16-11 and 16-12).";
    if (scenario.demand.arrivals == "even") {
        delays +=
            " With demand.arrivals: even, vehicles arrive evenly spaced. On lanes without left turns, simulated delays "
            "then contain little of d2.";
    }
    notes.push_back(std::move(delays));
    return paragraphs_text(notes);
}

bool has_offset(const Scenario& scenario) { return timing_overrides(scenario, {}).size() > 2; }

std::string interval_cell(const MeanInterval& value, int decimals, bool with_sign) {
    const std::string mean =
        with_sign ? fmt::format("{:+.{}f}", value.mean, decimals) : fmt::format("{:.{}f}", value.mean, decimals);
    if (std::isnan(value.interval.low)) return mean;
    return fmt::format("{} ({:.{}f} .. {:.{}f})", mean, value.interval.low, decimals, value.interval.high, decimals);
}

}  // namespace

std::string timing_text(const Scenario& scenario, const std::vector<PopulationTiming>& timings) {
    std::string text = lanes_table(timings) + "\n" + signals_table(timings, has_offset(scenario)) + "\n" +
                       assumptions_text(timings, scenario, has_offset(scenario));
    for (const PopulationTiming& one : timings) {
        if (one.is_oversaturated()) text += "\n" + oversaturation_text(one);
        if (one.greens_agree) continue;
        text += fmt::format(
            "\n{}: the measured and the resulting greens do not agree within 1 s; the times follow from the last run.\n",
            one.saturation.population);
    }
    return text;
}

std::string apply_text(const Scenario& scenario, const std::string& population, const SignalTimes& times) {
    std::string options;
    for (const std::string& text : timing_overrides(scenario, times)) options += " --set " + shell_word(text);
    return fmt::format("{}:{}\n{}", population, options, timing_yaml(scenario, times));
}

std::string search_text(const Scenario& scenario, const TimingSearch& search,
                        const std::array<double, kTimingStages>& shortest_s) {
    constexpr std::size_t kShown = 5;
    const bool is_delay = search.objective == Objective::delay;
    const int decimals = is_delay ? 1 : 0;
    TextTable table("lrrrrrr");
    table.add_row({"", "green", "cross green", "offset", "cycle", is_delay ? "mean delay" : "throughput",
                   "difference to the start values"});
    table.add_row({"", "s", "s", "s", "s", is_delay ? "s" : "veh/h", is_delay ? "s" : "veh/h"});
    const auto add = [&](const std::string& name, std::size_t setting) {
        const SearchedTimes& one = search.all[setting];
        const MeanInterval mean = mean_interval(one.values(search.objective));
        table.add_row(
            {name, number_cell(one.times.green_s[0], 0), number_cell(one.times.green_s[1], 0),
             has_offset(scenario) ? number_cell(one.times.offset_s, 0) : "-", number_cell(one.cycle_s, 0),
             interval_cell(mean, decimals, false),
             setting == search.start ? "-" : interval_cell(difference_to_start(search, setting), decimals, true)});
    };
    add("start values", search.start);
    for (std::size_t k = 0; k < std::min(kShown, search.best.size()); ++k) {
        add(k == 0 ? "best" : fmt::format("{}.", k + 1), search.best[k]);
    }
    const std::size_t seeds = search.all[search.start].delay_s.size();
    std::string text = fmt::format("{}: {} settings, {} seed{}\n{}", search.population, search.all.size(), seeds,
                                   seeds == 1 ? "" : "s", table.text());
    if (seeds > 1)
        text += "  In brackets: 95 % confidence interval. Differences are taken between runs with equal seeds.\n";
    if (is_best_at_border(search, shortest_s)) {
        text +=
            "  The best setting is at the border of the searched greens: widen the search, e.g. with --range 2.5.\n";
    }
    return text;
}

}  // namespace stopline

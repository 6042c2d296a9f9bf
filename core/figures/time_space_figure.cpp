#include "figures/time_space_figure.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "figures/population_style.h"
#include "measure/area.h"
#include "scenario/kinds/network_kind.h"
#include "scenario/make_network.h"

namespace stopline {

namespace {

// Returns the curves of all vehicles with this policy, as data for gnuplot. A curve is interrupted while its vehicle is
// not on the street.
std::string lines_of(const StreetTrace& trace, int policy) {
    std::map<int, std::vector<const StreetPoint*>> by_vehicle;
    for (const StreetPoint& point : trace.points) {
        if (point.policy == policy) by_vehicle[point.vehicle].push_back(&point);
    }
    std::string text = "# time_s position_m; empty lines separate vehicles\n";
    for (const auto& [vehicle, points] : by_vehicle) {
        double before_s = points.front()->time_s;
        for (const StreetPoint* const point : points) {
            if (point->time_s > before_s + 1.5 * kTimeSpaceSample_s) text += "\n";
            text += fmt::format("{:.0f} {:.1f}\n", point->time_s, point->position_m);
            before_s = point->time_s;
        }
        text += "\n";
    }
    return by_vehicle.empty() ? text + "NaN NaN\n" : text;
}

// Returns the reason why there is nothing to draw, or an empty text.
std::string reason_for_no_figure(const std::vector<StreetTrace>& traces, const std::string& from) {
    if (std::any_of(traces.begin(), traces.end(),
                    [](const StreetTrace& trace) { return !trace.points.empty() || !trace.reds.empty(); })) {
        return "";
    }
    if (traces.empty() || !(traces[0].length_m > 0.0)) return "no street crosses the network from the " + from;
    return fmt::format("no vehicle and no red signal in the last {:g} s (measure.time_space), sampled every {:g} s",
                       traces[0].to_s - traces[0].from_s, kTimeSpaceSample_s);
}

// Returns the title, such as "Row r2 from west to east, straight on from lane c0r2_west_in_1".
std::string street_title(const Scenario& scenario, const StreetTrace& trace) {
    const Side from = side_named(scenario.measure.time_space_side);
    const auto to = (static_cast<std::size_t>(from) + 2) % kSideNames.size();
    const std::string street =
        network_kind(scenario.network).diagram_street(scenario.network, make_network(scenario.network), from).title;
    std::string title = fmt::format("{} from {} to {}, straight on from lane {}", street,
                                    scenario.measure.time_space_side, kSideNames[to], trace.first_lane);
    if (!trace.reaches_exit) {
        title +=
            fmt::format("; no lane goes straight through the whole street: this one ends at {:.0f} m", trace.length_m);
    }
    return title;
}

}  // namespace

Figure time_space_figure(const Scenario& scenario, const std::vector<std::string>& populations,
                         const std::vector<StreetTrace>& traces) {
    Figure figure;
    figure.name = "time_space";
    figure.width_px = 1100;
    figure.height_px = 150 + 330 * static_cast<int>(populations.size());
    figure.nothing = reason_for_no_figure(traces, scenario.measure.time_space_side);
    if (traces.empty()) return figure;
    std::string body = fmt::format(
        "set multiplot layout {},1 title {} margins 0.08,0.86,{:.4f},{:.4f} spacing {:.4f}\nset key outside right "
        "top\nset ylabel 'distance from the {} end [m]'\n",
        populations.size(), gnuplot_text(street_title(scenario, traces[0])), 70.0 / figure.height_px,
        1.0 - 80.0 / figure.height_px, 80.0 / figure.height_px, scenario.measure.time_space_side);
    for (std::size_t k = 0; k < populations.size(); ++k) {
        const StreetTrace& trace = traces[k];
        std::string reds = "# time_s position_m, red times at the stop lines\n";
        for (const RedPhase& red : trace.reds) {
            reds +=
                fmt::format("{:.0f} {:.1f}\n{:.0f} {:.1f}\n\n", red.from_s, red.stop_line_m, red.to_s, red.stop_line_m);
        }
        figure.data.emplace_back(fmt::format("time_space_{}_red.dat", k), reds + "NaN NaN\n");
        body += fmt::format("set title {}\nset xrange [{}:{}]\nset yrange [0:{:.0f}]\n{}plot ",
                            gnuplot_text(populations[k]), trace.from_s, trace.to_s, trace.length_m,
                            k + 1 == populations.size() ? "set xlabel 'time [s]'\n" : "set xlabel ' '\n");
        for (std::size_t p = 0; p < trace.policies.size(); ++p) {
            const std::string name = fmt::format("time_space_{}_{}.dat", k, p);
            figure.data.emplace_back(name, lines_of(trace, static_cast<int>(p)));
            body += fmt::format("'{}' with lines lw 0.8 dt 1 lc rgb '{}' title {}, ", name,
                                style_of(scenario, trace.policies[p]).colour, gnuplot_text(trace.policies[p]));
        }
        body += fmt::format("'time_space_{}_red.dat' with lines lw 3 dt 1 lc rgb '#000000' title 'red'\n", k);
    }
    figure.body = body + "unset multiplot\n";
    return figure;
}

Figure time_space_figure(const NetworkReport& report) {
    std::vector<std::string> names;
    std::vector<StreetTrace> traces;
    for (const NetworkResult& f : report.populations) {
        names.push_back(f.population);
        traces.push_back(f.street_trace);
    }
    return time_space_figure(report.scenario, names, traces);
}

}  // namespace stopline

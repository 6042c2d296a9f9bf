// Checks that several kinds of networks share.
#include <cmath>
#include <cstddef>

#include "scenario/kinds/kind_parts.h"
#include "scenario/schema/quantity.h"

namespace stopline {

void check_whole_steps(const Scenario& scenario, const std::string& field, double time_s, Checker& check) {
    const double steps = time_s / scenario.tick_s();
    if (std::abs(steps - std::round(steps)) <= 1e-6) return;
    check.error(field, short_text(time_s, unit("s")) + " is not a whole number of steps of " +
                           short_text(scenario.tick_s(), unit("ms")));
}

void check_signal_steps(const Scenario& scenario, Checker& check) {
    const SignalSettings& signal = scenario.signal;
    check_whole_steps(scenario, "signal.first_green", signal.first_green_s, check);
    check_whole_steps(scenario, "signal.green", signal.green_s, check);
    check_whole_steps(scenario, "signal.cross_green", signal.cross_green_s, check);
    check_whole_steps(scenario, "signal.yellow", signal.yellow_s, check);
    check_whole_steps(scenario, "signal.all_red", signal.all_red_s, check);
    check_whole_steps(scenario, "signal.cycle", signal.cycle_s, check);
    check_whole_steps(scenario, "signal.offset", signal.offset_s, check);
    for (std::size_t i = 0; i < scenario.measure.green_s.size(); ++i) {
        check_whole_steps(scenario, "measure.green[" + std::to_string(i) + "]", scenario.measure.green_s[i], check);
    }
}

void check_green_times(const Scenario& scenario, Checker& check) {
    const SignalSettings& signal = scenario.signal;
    for (std::size_t i = 0; i < scenario.measure.green_s.size(); ++i) {
        const double green_s = scenario.measure.green_s[i];
        const std::string field = "measure.green[" + std::to_string(i) + "]";
        if (green_s > signal.green_s) {
            check.error(field, "lies after the end of the green time of " + short_text(signal.green_s, unit("s")));
        } else if (signal.first_green_s + green_s > scenario.duration_s) {
            check.error(field, "the run ends earlier, at duration = " + short_text(scenario.duration_s, unit("s")));
        }
    }
}

void check_first_green(const Scenario& scenario, Checker& check) {
    const SignalSettings& signal = scenario.signal;
    if (signal.first_green_s >= scenario.duration_s) {
        check.error("signal.first_green", "value " + short_text(signal.first_green_s, unit("s")) +
                                              " must be below the duration of the run, " +
                                              short_text(scenario.duration_s, unit("s")));
    }
}

void refuse_cycle(const Scenario& scenario, Checker& check) {
    const SignalSettings& signal = scenario.signal;
    if (signal.cycle_s == 0.0 || find_signal_controller(signal.controller).runs_rings) return;
    const std::string times = signal.has_phases() ? "the phases, " : "green, cross_green, yellow and all_red, ";
    check.error("signal.cycle", "must be left out here: it follows from " + times +
                                    short_text(scenario.nominal_cycle().cycle_s, unit("s")));
}

void refuse_phases(const Scenario& scenario, const std::string& network, Checker& check) {
    if (!scenario.signal.has_phases()) return;
    check.error(scenario.signal.phases.empty() ? "signal.programmes" : "signal.phases", "is not for " + network);
}

void refuse_offset(const Scenario& scenario, Checker& check) {
    if (scenario.signal.offset_s == 0.0) return;
    check.error("signal.offset", "is for grids only: it delays the greens from one intersection to the next");
}

void refuse_cross_inflow(const Scenario& scenario, Checker& check) {
    if (scenario.demand.cross_inflow_1ps == 0.0) return;
    check.error("demand.cross_inflow", "is for intersections and grids only");
}

}  // namespace stopline

// All populations of several intersections, side by side in threads, and what is reported of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiment/gnuplot.h"
#include "experiment/network_run.h"

namespace stopline {

struct NetworkReport {
    Scenario scenario;
    std::vector<NetworkFigures> populations;  // in the order of the scenario
    std::vector<std::string> lanes;           // names, as events number them

    // Of throughput over the baseline, and of travel time below it, in percent; NaN without one. The latter is NaN too where either
    // leaves_few().
    double improvement_percent(const NetworkFigures& figures) const;
    double time_saved_percent(const NetworkFigures& figures) const;
    bool no_violations() const;
};

// Travel times are of those that get out. Where the vehicles in the area, over what leaves it, are there for half as long again or more
// (Little's law), these are not typical: many do not get out.
bool leaves_few(const NetworkFigures& figures);

struct NetworkOptions {
    int threads = 1;
    std::function<bool(double)> on_progress;  // gets the share done; returns false to stop: throws Interrupted
    Observation observation = {};
};

// The same bits for any number of threads.
NetworkReport run_networks(const Scenario& scenario, const NetworkOptions& options);

// From when to when is measured; and why that is not what measure.steady asks for, where it is not.
std::string window_text(const NetworkReport& report);

std::string network_csv(const NetworkReport& report);         // a row a population
std::string network_series_csv(const NetworkReport& report);  // a row a population and interval
std::string network_ways_csv(const NetworkReport& report);    // by side of entry and exit
std::string hindrance_csv(const NetworkReport& report);       // a row an episode
std::string gridlocks_csv(const NetworkReport& report);       // a row a member
std::string rules_csv(const NetworkReport& report);           // a row a use

// Throughput, travel time, density and vehicles moved on over time (Fig. 22).
Figure network_series_figure(const NetworkReport& report);
// Where vehicles of one street are over time (Fig. 16), where measure.time_space asks for it.
Figure street_figure(const NetworkReport& report);
std::string street_csv(const NetworkReport& report);
// What vehicles' time is lost to.
Figure hindrance_figure(const NetworkReport& report);

}  // namespace stopline

// Result tables of stopline-signals for the terminal.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "signal_timing/signal_timing.h"
#include "signal_timing/timing_search.h"

namespace stopline {

// Returns the tables of the timings, and below them the assumptions.
std::string timing_text(const Scenario& scenario, const std::vector<PopulationTiming>& timings);

// Returns the options that apply the times, such as "--set 'signal.green=17 s'", and the section `signal` as YAML.
std::string apply_text(const Scenario& scenario, const std::string& population, const SignalTimes& times);

// Returns a table of the best settings of a search, with their differences to the start values. `shortest_s` are the
// shortest greens that are allowed.
std::string search_text(const Scenario& scenario, const TimingSearch& search,
                        const std::array<double, kTimingStages>& shortest_s);

}  // namespace stopline

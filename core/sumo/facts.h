// What a run is compared by: the same quantities of our runs and of SUMO's.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "record/run_writer.h"
#include "sim/model.h"

namespace stopline {

// All times in seconds from the beginning of the run.
struct RunFacts {
    struct Trip {
        double arrival_s = 0.0;
        double duration_s = 0.0;  // in the network
        double delay_s = 0.0;     // waited outside for room; 0 where no departure is planned
    };
    // Every second.
    struct Instant {
        double time_s = 0.0;
        int present = 0;
        int halting = 0;              // slower than 0.1 m/s
        double mean_speed_mps = 0.0;  // where nobody is present: nothing that counts
        int waiting = 0;              // outside, for room
    };
    std::vector<Trip> trips;                              // that have ended
    std::map<std::string, std::vector<double>> passed_s;  // by lane, fronts past its stop line
    std::vector<Instant> instants;
    std::int64_t moved_on =
        0;  // vehicles: SUMO's teleports; ours by a rule, or from a lane that does not serve their way
};

// Sums over a part of the run.
struct RunSummary {
    double throughput_veh_h = 0.0;  // trips that ended
    double travel_time_s = 0.0;     // mean of them
    double delay_s = 0.0;           // mean wait outside
    double passages_veh_h = 0.0;    // at all stop lines
    double speed_mps = 0.0;         // mean over time, while vehicles are there, of their mean
    double halting = 0.0;           // mean number: the queues
    double waiting = 0.0;           // found no room to enter until the end
};
RunSummary summary_of(const RunFacts& facts, double from_s, double to_s);

// Watches one of our runs. `stop_lines`: [lane] the name under which passages of its stop line are counted; empty: they are not.
// Keeps the other references, and fills in `facts` until it has finished.
std::unique_ptr<RunWriter> make_facts_writer(const Model& model, std::vector<std::string> stop_lines, RunFacts& facts);

// Of a run of SUMO with the files of sumo/inputs.h: trips.out.xml, detectors.out.xml, summary.out.xml in a folder. Throws InputError
// where one is missing or not what SUMO writes. `has_loops`: without loops there is no detectors.out.xml.
RunFacts read_sumo_facts(const std::filesystem::path& folder, bool has_loops);

}  // namespace stopline

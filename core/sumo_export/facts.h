// The data of one run for a comparison, in the same form for a run of Stopline ('our run') and for a run of SUMO.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "record/run_writer.h"
#include "sim/state/model.h"

namespace stopline {

// All times count from the beginning of the run.
struct RunFacts {
    struct Trip {
        double arrival_s = 0.0;
        double duration_s = 0.0;         // time in the network
        double departure_delay_s = 0.0;  // from the planned departure to the insertion; 0 without planned departures
    };
    // The state at a full second.
    struct Instant {
        double time_s = 0.0;
        int present = 0;              // vehicles in the network
        int stopped = 0;              // vehicles slower than 0.1 m/s
        double mean_speed_mps = 0.0;  // undefined if no vehicle is present
        int backlog = 0;              // vehicles that wait for insertion
    };
    std::vector<Trip> trips;                              // completed trips
    std::map<std::string, std::vector<double>> passed_s;  // [stop line] times at which a front passed
    std::vector<Instant> instants;
    std::int64_t teleported = 0;  // number of teleports; in our runs including teleports after missed turns
};

// Totals and means over a period of the run.
struct RunSummary {
    double throughput_veh_h = 0.0;   // completed trips per hour
    double travel_time_s = 0.0;      // mean time in the network over the completed trips
    double departure_delay_s = 0.0;  // mean departure delay over the completed trips
    double passages_veh_h = 0.0;     // passages per hour, summed over all stop lines
    double speed_mps = 0.0;          // mean of Instant::mean_speed_mps over the instants at which vehicles are present
    double stopped = 0.0;            // mean over time of the number of stopped vehicles
    double backlog = 0.0;            // vehicles that wait for insertion at the end of the period
};
// Returns the summary of the period after `from_s` and up to `to_s`. Means without data are NaN.
RunSummary summary_of(const RunFacts& facts, double from_s, double to_s);

// Returns a writer that collects `facts` from a run of Stopline. For each lane, `stop_lines` holds the name under which
// the writer counts the passages of the stop line. If the name is "", the writer does not count them. The writer keeps
// references to `model` and `facts`.
std::unique_ptr<RunWriter> make_facts_writer(const Model& model, std::vector<std::string> stop_lines, RunFacts& facts);

// Reads the output files of a SUMO run: trips.out.xml, summary.out.xml and, if `has_loops`, detectors.out.xml. Throws
// InputError if a file is missing or malformed.
RunFacts read_sumo_facts(const std::filesystem::path& folder, bool has_loops);

}  // namespace stopline

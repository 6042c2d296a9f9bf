// A SUMO network as its file states it: edges, lanes, connections, junctions and signal programmes. All ids are
// resolved and checked. sumo_graph.h turns the network into a LaneGraph. SI units.
//
// Formats: https://sumo.dlr.de/docs/Networks/SUMO_Road_Networks.html and .../Simulation/Traffic_Lights.html.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "network/geometry.h"

namespace stopline {

// Warnings about content of SUMO's files that the import ignores or changes.
class SumoWarnings {
public:
    // Adds a warning. `where` is file and line.
    void note(const std::string& where, const std::string& message);
    // Returns the text of all warnings. Of each message only the first few places are listed; the others are counted.
    std::vector<std::string> lines() const;

private:
    struct Kind {
        std::string message;
        std::vector<std::string> places;  // file:line
        int count = 0;
    };
    std::vector<Kind> kinds_;
};

struct SumoLane {
    double length_m = 0.0;
    double speed_mps = 0.0;
    bool allows_cars = true;  // passenger cars may use the lane
    Polyline shape = {};
    // Names of the SUMO lanes at whose ends this lane ends after short edges were merged into its edge. Empty: none
    // was.
    std::vector<std::string> end_lanes = {};
};

struct SumoEdge {
    std::string id;
    bool internal = false;             // inside a junction
    std::vector<SumoLane> lanes = {};  // [index], from the right
    std::string where;                 // file:line
    int merged_into = -1;              // edge that took over this short edge (sumo_short_edges.h); -1: none
};

// A connection from one lane to another. Members have the names of SUMO's attributes.
struct SumoConnection {
    int from = -1;  // edge
    int from_lane = 0;
    int to = -1;  // edge
    int to_lane = 0;
    int via = -1;  // internal edge; -1: none
    int via_lane = 0;
    int tl = -1;       // index in SumoNet::signals; -1: no signal
    int tl_link = -1;  // index of the letter in the phases of that signal
    char dir = 's';    // s straight, l, L left, r, R right, t turnaround, i invalid
    char state = 'M';  // M major, m minor, = equal, s stop, w allway stop, Z zipper, o off, - dead end
    bool keep_clear = true;
    bool pass = false;  // vehicles never yield
    std::string where;
};

// A junction with its right-of-way matrices. Links are numbered like the requests in the file.
struct SumoJunction {
    std::string id;
    std::string type;
    std::vector<std::string> incoming = {};        // ids of the incoming lanes
    std::vector<std::vector<bool>> response = {};  // [link][other] the link yields to the other
    std::vector<std::vector<bool>> foes = {};      // [link][other] the two links conflict
    std::vector<bool> cont = {};                   // [link] a yielding vehicle waits inside the junction
    std::string where = {};                        // file:line
};

struct SumoPhase {
    double duration_s = 0.0;
    std::string state;  // one letter for each link
};

struct SumoSignal {
    std::string id;
    std::string programme;
    double offset_s = 0.0;
    std::vector<SumoPhase> phases = {};  // empty until a programme was read
    std::string where;                   // file:line
    bool defined_in_net = false;         // the network file contains a programme

    double cycle_s() const;
};

// An induction loop of an additional file.
struct SumoLoop {
    std::string id;
    int edge = -1;
    int lane = 0;
    double position_m = 0.0;  // from the start of the lane
    std::string where;        // file:line
};

struct SumoNet {
    std::filesystem::path file;  // absolute
    std::vector<SumoEdge> edges;
    std::vector<SumoConnection> connections;
    std::vector<SumoJunction> junctions;
    std::vector<SumoSignal> signals;
    std::vector<SumoLoop> loops;
    std::unordered_map<std::string, int> edge_by_id;
    std::unordered_map<std::string, int> signal_by_id;
    std::unordered_map<std::string, std::pair<int, int>> link_of;  // [id of an internal lane] junction and link
    SumoWarnings warnings;
    std::uint64_t hash = 0;  // of the text of all files read

    // Returns edge and lane index for the id of a lane, or nothing if there is no such lane.
    std::optional<std::pair<int, int>> lane(std::string_view id) const;
    // Returns the index of the signal with this id, and adds a signal without a programme if there is none.
    int signal(const std::string& id);
    // Throws InputError if a connection's signal has no programme or too few letters. Call it after reading all files.
    void check_lights() const;
};

// Reads a network file. Throws InputError with file and line.
SumoNet read_sumo_net(const std::filesystem::path& file);
// Reads signal programmes, offsets and induction loops of an additional file into `net`. Throws InputError.
void read_sumo_additional(const std::filesystem::path& file, SumoNet& net);

// Returns true if the attributes `allow` and `disallow` admit passenger cars.
bool sumo_allows_cars(std::string_view allow, std::string_view disallow);
// Appends the points to the line and skips points that coincide with the one before.
void sumo_append(Polyline& line, const Polyline& points);
// Returns the points of a text such as "0,0 5.5,3.2,0", or nothing if the text is malformed. Drops z coordinates and
// skips points that coincide with the one before.
std::optional<Polyline> sumo_shape(std::string_view text);

}  // namespace stopline

// A SUMO network as its file says it: edges, lanes, connections, junctions and signal programmes, with ids resolved and checked. What it
// becomes here: sumo_graph.h.
//
// Read: https://sumo.dlr.de/docs/Networks/SUMO_Road_Networks.html and .../Simulation/Traffic_Lights.html. SI units.
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

// What a file has that is not read, with file and line. Of each kind some are kept, and the rest counted.
class SumoWarnings {
public:
    void note(const std::string& where, const std::string& what);
    std::vector<std::string> lines() const;

private:
    struct Kind {
        std::string what;
        std::vector<std::string> places;
        int count = 0;
    };
    std::vector<Kind> kinds_;
};

struct SumoLane {
    double length_m = 0.0;
    double speed_mps = 0.0;
    bool cars = true;  // passenger cars may drive there
    Polyline shape = {};
    std::vector<std::string> ends =
        {};  // lanes of edges that were joined to its own, at whose ends it ends; none: at its own
};

struct SumoEdge {
    std::string id;
    bool internal = false;
    std::vector<SumoLane> lanes = {};  // by index, from the right
    std::string where;                 // file:line
    int joined_to = -1;                // the edge whose end it is (sumo_short_edges.h)
};

// From a lane of an edge, or of an internal one, to another.
struct SumoConnection {
    int from = -1;  // edge
    int from_lane = 0;
    int to = -1;
    int to_lane = 0;
    int via = -1;  // internal edge; -1: none
    int via_lane = 0;
    int tl = -1;  // signal programme and link in it; -1: none
    int tl_link = -1;
    char dir = 's';    // s straight, l, L left, r, R right, t turnaround, i invalid
    char state = 'M';  // M major, m minor, = equal, s stop, w allway stop, Z zipper, o off, - dead end
    bool keep_clear = true;
    bool pass = false;  // gives way to nobody
    std::string where;
};

// Who gives way to whom; links are counted as in the file's requests.
struct SumoJunction {
    std::string id;
    std::string type;
    std::vector<std::string> incoming = {};        // ids of lanes
    std::vector<std::vector<bool>> response = {};  // [link][other] waits for the other
    std::vector<std::vector<bool>> foes = {};      // [link][other] their ways meet
    std::vector<bool> cont = {};                   // [link] who waits does so inside
    std::string where = {};                        // file:line
};

struct SumoPhase {
    double duration_s = 0.0;
    std::string state;  // a letter a link
};

struct SumoSignal {
    std::string id;
    std::string programme;
    double offset_s = 0.0;
    std::vector<SumoPhase> phases =
        {};  // none: connections name it, and its programme may follow in an additional file
    std::string where;
    bool in_net = false;  // the file of the network has a programme

    double cycle_s() const;
};

// Induction loops of additional files.
struct SumoLoop {
    std::string id;
    int edge = -1;
    int lane = 0;
    double position_m = 0.0;
    std::string where;  // file:line
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
    std::unordered_map<std::string, std::pair<int, int>> link_of;  // internal lane -> junction and link
    SumoWarnings warnings;
    std::uint64_t hash = 0;  // of the files

    // Edge and index of a lane; none: there is no such lane.
    std::optional<std::pair<int, int>> lane(std::string_view id) const;
    // The signal of this id, which may have no programme yet.
    int signal(const std::string& id);
    // Throws InputError where a connection's light has no programme, or one without its link. After all additional files.
    void check_lights() const;
};

// Throws InputError, with file and line, where the file cannot be used.
SumoNet read_sumo_net(const std::filesystem::path& file);
// Programmes, offsets and induction loops of an additional file.
void read_sumo_additional(const std::filesystem::path& file, SumoNet& net);

// Whether passenger cars are among those that `allow` and `disallow` say.
bool sumo_allows_cars(std::string_view allow, std::string_view disallow);
// Adds the points of one line to another, but for those that are at the same place.
void sumo_append(Polyline& line, const Polyline& more);
// Points "x,y" or "x,y,z" between blanks; those at the same place are one. None: a number is not finite.
std::optional<Polyline> sumo_shape(std::string_view text);

}  // namespace stopline

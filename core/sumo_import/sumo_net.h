// The content of a SUMO network file: edges, lanes, connections, junctions and signal programmes. All references
// between elements have been checked. sumo_graph.h turns the network into a LaneGraph. SI units.
//
// Formats: https://sumo.dlr.de/docs/Networks/SUMO_Road_Networks.html and .../Simulation/Traffic_Lights.html.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "network/geometry.h"
#include "sumo_import/sumo_xml.h"

namespace stopline {

// Limits of a network. Some steps of the import compare each lane of an edge, and each connection of a junction, with
// all others.
inline constexpr std::size_t kSumoLanesMax = 100;             // of an edge
inline constexpr std::size_t kSumoConnectionsMax = 100;       // that begin on one lane
inline constexpr std::size_t kSumoLinksMax = 1000;            // of a junction; SUMO allows 256
inline constexpr std::size_t kSumoPhasesMax = 1000;           // of a signal programme
inline constexpr double kSumoConnectionLengthMax_m = 2000.0;  // of the path through a junction
inline constexpr std::size_t kSumoPointsMax = 1000;           // of the path through a junction

// Warnings about content of SUMO's files that the import ignores or changes.
class SumoWarnings {
public:
    // Adds a warning. `where` names file and line.
    void note(const std::string& where, const std::string& message);
    // Returns all warnings as lines of text. If many places cause the same message, the text lists the first few places
    // and the number of further places.
    std::vector<std::string> lines() const;

private:
    struct Kind {
        std::string message;
        std::vector<std::string> places;  // file:line
        int count = 0;
    };
    std::vector<Kind> kinds_;
    std::unordered_map<std::string, std::size_t> kind_by_message_;
};

struct SumoLane {
    double length_m = 0.0;
    double speed_mps = 0.0;   // speed limit
    bool allows_cars = true;  // passenger cars may use the lane
    Polyline shape = {};
    // If short edges were merged into the edge of this lane, the lane ends where one or more lanes of the short edges
    // ended. This list holds the ids of those lanes. Otherwise the list is empty.
    std::vector<std::string> end_lanes = {};
    // If short edges were merged into the edge of this lane: ids and lengths of the lanes of which this lane consists,
    // in driving order. Otherwise the list is empty.
    std::vector<std::pair<std::string, double>> merged_lanes = {};
};

struct SumoEdge {
    std::string id;
    bool internal = false;             // inside a junction
    std::vector<SumoLane> lanes = {};  // [index], from the right
    std::string where;                 // file:line
    int merged_into = -1;              // edge into which this edge was merged (sumo_short_edges.h); -1: not merged
};

// A connection from one lane to another. The members are named like the attributes in SUMO's file.
struct SumoConnection {
    int from = -1;  // edge
    int from_lane = 0;
    int to = -1;  // edge
    int to_lane = 0;
    int via = -1;  // internal edge; -1: none
    int via_lane = 0;
    int tl = -1;       // index in SumoNet::signals; -1: no signal
    int tl_link = -1;  // index of the connection's letter in SumoPhase::state
    char dir = 's';    // s straight, l, L left, r, R right, t turnaround, i invalid
    char state = 'M';  // M major, m minor, = equal, s stop, w allway stop, Z zipper, o off, - dead end
    bool keep_clear = true;
    bool pass = false;  // vehicles on this connection never yield
    std::string where;  // file:line
};

// A junction with its right-of-way matrices. A link is a connection through the junction; link k is described by the
// k-th `request` element in the file.
struct SumoJunction {
    std::string id;
    std::string type;
    std::vector<std::string> incoming = {};        // ids of the incoming lanes
    std::vector<std::vector<bool>> response = {};  // [link][other link] true: the link yields to the other link
    std::vector<std::vector<bool>> foes = {};      // [link][other link] true: the links conflict
    std::vector<bool> cont = {};                   // [link] true: a yielding vehicle waits inside the junction
    std::string where = {};                        // file:line
};

struct SumoPhase {
    double duration_s = 0.0;
    std::string state;  // one letter for the light of each link of the signal
    // For controllers that react to traffic:
    std::string name = {};
    double min_s = 0.0;  // minimum and maximum green
    double max_s = 0.0;
    double extension_s = 0.0;  // NEMA: time by which a vehicle extends the green
    double yellow_s = 0.0;     // NEMA
    double red_s = 0.0;        // NEMA
    std::vector<int> next = {};
};

struct SumoController;  // controllers/sumo_controller.h

struct SumoSignal {
    std::string id;
    std::string programme;  // SUMO's programID
    double offset_s = 0.0;
    std::vector<SumoPhase> phases = {};  // empty until a programme is read
    std::string where;                   // file:line
    bool defined_in_net = false;         // the network file contains a programme for this signal
    std::string type = {};               // static, actuated, NEMA, ...
    std::map<std::string, std::string> parameters = {};
    // Set by set_sumo_controllers(); null: the signal follows its phases as a fixed-time programme.
    std::shared_ptr<SumoController> controller = {};

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
    std::filesystem::path file;          // absolute path of the network file
    std::optional<SumoVersion> version;  // version of SUMO that wrote the network file, if the file tells it
    std::vector<SumoEdge> edges;
    std::vector<SumoConnection> connections;
    std::vector<SumoJunction> junctions;
    std::vector<SumoSignal> signals;
    std::vector<SumoLoop> loops;
    std::unordered_set<std::string> loop_ids;
    std::unordered_map<std::string, int> edge_by_id;
    std::unordered_map<std::string, int> signal_by_id;
    std::unordered_map<std::string, std::pair<int, int>> link_of;  // [id of an internal lane] junction and link
    SumoWarnings warnings;
    std::uint64_t hash = 0;  // hash of the text of the network file and all additional files

    // Returns edge and lane index for the id of a lane, or nothing if there is no such lane.
    std::optional<std::pair<int, int>> lane(std::string_view id) const;
    // Returns the index of the signal with this id. If there is no such signal, adds one without a programme.
    int signal(const std::string& id);
    // Throws InputError if the signal of a connection has no programme, or if its phases have no letter for the
    // connection. Call this function after all files are read.
    void check_lights() const;
};

// Reads a network file. Throws InputError with file and line if the file is invalid.
SumoNet read_sumo_net(const std::filesystem::path& file);
// Reads signal programmes, offsets and induction loops of an additional file into `net`. Throws InputError with file
// and line if the file is invalid.
void read_sumo_additional(const std::filesystem::path& file, SumoNet& net);

// Returns true if a lane or connection with these values of `allow` and `disallow` is open to passenger cars.
bool sumo_allows_cars(std::string_view allow, std::string_view disallow);
// Appends the points to the line. Skips each point that coincides with the point before it.
void sumo_append(Polyline& line, const Polyline& points);
// Returns the points of a text such as "0,0 5.5,3.2,0", or nothing if the text is malformed. Ignores z coordinates and
// skips each point that coincides with the point before it.
std::optional<Polyline> sumo_shape(std::string_view text);

}  // namespace stopline

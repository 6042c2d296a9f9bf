// Kinds of networks: the values of the field network.kind. A kind defines its fields in the section `network`, checks
// them, and builds the lane graph, the signals and the demand from them. Code outside this folder should read the
// properties of a kind instead of comparing its name.
//
// To add a kind, write a file scenario/kinds/<name>.cpp that defines a NetworkKind, and add it to the list in
// network_kinds.cpp.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "network/outer_leg.h"
#include "network/side.h"
#include "scenario/import_sumo.h"
#include "scenario/scenario.h"
#include "scenario/schema/field_rows.h"
#include "sim/state/model.h"

namespace stopline {

// The names of the ways of running a scenario (RunKind in runs/run_kind.h). scenarios/COLUMNS.md puts this name before
// the name of a table, as in `network/summary.csv`.
inline constexpr std::string_view kRunAsSingleLight = "single_light";
inline constexpr std::string_view kRunAsIntersection = "intersection";
inline constexpr std::string_view kRunAsNetwork = "network";

// The street that a time-space diagram shows.
struct DiagramStreet {
    std::string lane_prefix;  // beginning of the names of the lanes on which vehicles enter the street; "": no street
    std::string title;        // such as "Row r2"
};

struct NetworkKind {
    const char* name = "";
    const char* meaning = "";  // description in lists for the user
    // How a scenario is run, measured and reported: one of the names above.
    std::string_view run;

    // Number of signal groups of each intersection that the section `signal` describes. 0: the kind has signals of its
    // own, and the section is not allowed, unless `chooses_controller` is true.
    int signal_groups = 0;
    // The signals of the kind have times of their own, and the section `signal` names their controller.
    bool chooses_controller = false;
    // Vehicles follow trips from files. The section `demand` is then not allowed, and the whole network is measured.
    bool has_trips = false;
    bool has_intersections = true;   // false: a road without conflicts, on which the section `rules` has no effect
    bool is_exportable = true;       // SUMO can run the network; false: it comes from files of SUMO
    bool ends_after_cycles = false;  // a run can end after its measured signal cycles (duration 0 s)
    // Traffic is counted each second in an area (measure.area_margin, interval, window).
    bool has_measured_area = false;
    bool reports_approaches = false;  // results for each approach and turn

    // The fields of the kind in the section `network`. Kinds that return a row of the same name share the field.
    std::vector<Row<NetworkSettings>> (*fields)() = nullptr;
    LaneGraph (*graph)(const NetworkSettings& network) = nullptr;
    // Adds the signals, and the rights of way that change with the signals. The model already has its lane graph.
    void (*add_signals)(const Scenario& scenario, Model& model) = nullptr;
    // Adds the traffic. The model already has its lane graph and its spacing policies.
    void (*add_demand)(const Scenario& scenario, Model& model) = nullptr;
    // Returns the legs that lead to the border of the network. Legs that are equal by definition are listed once.
    std::vector<OuterLeg> (*outer_legs)(const NetworkSettings& network) = nullptr;
    double (*highest_limit_mps)(const NetworkSettings& network) = nullptr;  // highest speed limit
    double (*lane_width_m)(const NetworkSettings& network) = nullptr;       // for drawings
    // Checks the settings beyond the ranges of single fields. Checks that all kinds share are in
    // schema/fields/scenario.cpp.
    void (*check)(const Scenario& scenario, Checker& check) = nullptr;

    // Functions that a kind need not have.
    // Returns the distance from the stop line at the end of `lane` to the centre of the intersection, m. nullptr: 0.
    double (*radius_beyond_m)(const NetworkSettings& network, const Lane& lane) = nullptr;
    // Returns the nominal cycle of the intersections. nullptr: it follows from the section `signal`.
    NominalCycle (*nominal_cycle)(const Scenario& scenario) = nullptr;
    // Adds further detectors to a lane that is not a connection. Each stop line has a detector for all kinds. nullptr:
    // no further detectors.
    void (*add_detectors)(const Scenario& scenario, int lane, Model& model) = nullptr;
    // Returns the street that begins on one side of the network. nullptr: the kind has no time-space diagram.
    DiagramStreet (*diagram_street)(const NetworkSettings& network, const LaneGraph& graph, Side from) = nullptr;
    // Reads files that the scenario names, after its fields have been checked, and returns what is wrong with them.
    // Relative paths start at `directory`. nullptr: the kind has no files.
    std::vector<FieldProblem> (*import_files)(Scenario& scenario, const std::filesystem::path& directory) = nullptr;
};

// Returns all registered kinds.
std::span<const NetworkKind* const> network_kinds();
// Returns the names of the kinds for which a condition holds.
template <class Condition>
std::vector<std::string> kinds_with(const Condition& holds) {
    std::vector<std::string> names;
    for (const NetworkKind* kind : network_kinds()) {
        if (holds(*kind)) names.emplace_back(kind->name);
    }
    return names;
}
// Adds a kind that is not part of the project, such as the kind of a test. Call this function before the first scenario
// is loaded, because the list of fields is made then. The kind must exist until the end of the program.
void register_network_kind(const NetworkKind& kind);

// Returns the kind with the name network.kind. Throws InputError with a list of the known names if there is none.
const NetworkKind& network_kind(const NetworkSettings& network);

// Makes the row of a section of the kind. S is the struct of its settings, which only the file of the kind knows. The
// functions of the kind read the settings with own_settings<S>().
template <class S>
Row<NetworkSettings> own_section(std::string name, const Table& (*table)(), std::string meaning) {
    const SectionField section{
        [](void* network) -> void* { return &own_settings<S>(*static_cast<NetworkSettings*>(network)); },
        [](const void* network) -> const void* {
            return &own_settings<S>(*static_cast<const NetworkSettings*>(network));
        },
        table, ""};
    return {{std::move(name), std::move(meaning), section}};
}

}  // namespace stopline

// Fields of the network, the signal and the demand.
#include <string>

#include "network/street_checks.h"
#include "scenario/field_rows.h"
#include "scenario/fields.h"

namespace stopline {
namespace {

const Table& approach_table() {
    static const Table table = make_table<ApproachSettings>(
        "a straight road with a stop line",
        {
            whole<&ApproachSettings::lanes>("lanes", {1, 16}, "parallel lanes"),
            number<&ApproachSettings::length_m>("length", "m", {10, 20'000}, "from the entry to the stop line"),
            number<&ApproachSettings::exit_length_m>("exit_length", "m", {10, 20'000},
                                                     "from the stop line to the end of the road"),
            number<&ApproachSettings::speed_limit_mps>("speed_limit", "km/h", {5, 150}, "speed limit"),
            number<&ApproachSettings::gradient>("gradient", "%", {-20, 20}, "rise over run, positive uphill"),
        });
    return table;
}

const Table& lane_movements_table() {
    using L = IntersectionSettings::LaneMovements;
    static const Table table =
        make_table<L>("a lane of an approach",
                      {choice<&L::movements>("movements", lane_movements(), "where its vehicles may go").required()});
    return table;
}

const Table& intersection_table() {
    using S = IntersectionSettings;
    static const Table table = make_table<S>(
        "four arms at right angles, all alike",
        {
            list<&S::lanes>("lanes", lane_movements_table, {1, 6}, "lanes of each arm, from the left")
                .fallback("[{movements: straight+left}, {movements: straight+right}]"),
            number<&S::radius_m>("radius", "m", {5, 100}, "from the centre to the stop line"),
            number<&S::approach_length_m>("approach_length", "m", {50, 20'000}, "from the entry to the stop line"),
            number<&S::exit_length_m>("exit_length", "m", {20, 20'000}, "from the intersection to the end of the road"),
            number<&S::lane_width_m>("lane_width", "m", {2, 6}, "width of a lane"),
            number<&S::speed_limit_mps>("speed_limit", "km/h", {5, 150}, "speed limit"),
            number<&S::turn_speed_mps>("turn_speed", "m/s", {1, 40}, "speed on turning paths"),
            number<&S::clearance_m>(
                "clearance", "m", {1, 5},
                "vehicles whose centre lines are nearer than this touch; 0.5 m below lane_width or less"),
        },
        [](const S& s, Checker& check) {
            const std::string touching = clearance_problem(s.clearance_m, s.lane_width_m);
            if (!touching.empty()) check.error("clearance", touching);
            const double half_m = static_cast<double>(s.lanes.size()) * s.lane_width_m;
            if (half_m + s.clearance_m > s.radius_m) {
                check.error("radius",
                            "the lanes of an arm need at least " + short_text(half_m + s.clearance_m, unit("m")));
            }
        });
    return table;
}

const Table& grid_table() {
    using S = GridSettings;
    static const Table table = make_table<S>(
        "intersections, all alike, where streets cross",
        {
            whole<&S::columns>("columns", {1, 200}, "streets from south to north"),
            whole<&S::rows>("rows", {1, 200}, "streets from west to east"),
            number<&S::column_spacing_m>("column_spacing", "m", {50, 10'000}, "between centres, from west to east"),
            number<&S::row_spacing_m>("row_spacing", "m", {50, 10'000}, "between centres, from south to north"),
            choice<&S::shape>("shape", {"rectangle", "without_corners"},
                              "without_corners: three by three are then an intersection and its four neighbours"),
        },
        [](const S& s, Checker& check) {
            if (!s.has_corners() && (s.columns < 3 || s.rows < 3)) {
                check.error("shape", "only a grid of three by three or more can do without its corners");
            }
        });
    return table;
}

std::string seconds(double value) { return short_text(value, unit("s")); }

void check_signal(const SignalSettings& signal, Checker& check) {
    const double shortest = signal.green_s + signal.yellow_s + signal.all_red_s;
    if (signal.cycle_s != 0.0 && signal.cycle_s < shortest) {
        check.error("cycle", "a cycle of " + seconds(signal.cycle_s) + " is shorter than green + yellow + all red = " +
                                 seconds(shortest) + " (write 0 s for a single green)");
    }
}

}  // namespace

const Table& network_table() {
    static const Table table = make_table<NetworkSettings>(
        "the roads",
        {
            choice<&NetworkSettings::kind>("kind", {"approach", "intersection", "grid", "streets", "sumo"},
                                           "which generator builds the network; sumo: it is read from SUMO's files"),
            section<&NetworkSettings::approach>("approach", approach_table, "parameters of the kind 'approach'")
                .only("kind", {"approach"}),
            section<&NetworkSettings::intersection>("intersection", intersection_table,
                                                    "parameters of intersections, single or in a grid")
                .only("kind", {"intersection", "grid"}),
            section<&NetworkSettings::grid>("grid", grid_table, "parameters of the kind 'grid'").only("kind", {"grid"}),
            section<&NetworkSettings::streets>("streets", streets_table, "the network of the kind 'streets'", "berlin")
                .required()
                .only("kind", {"streets"}),
            text<&NetworkSettings::net>("net", TextField::Rule::title,
                                        "SUMO's network file, plain or gzipped, relative to the scenario's folder")
                .required()
                .only("kind", {"sumo"}),
            texts<&NetworkSettings::routes>("routes", TextField::Rule::title, {0, 1000},
                                            "SUMO's route files: vehicles, trips, flows, types")
                .only("kind", {"sumo"}),
            texts<&NetworkSettings::additional>("additional", TextField::Rule::title, {0, 1000},
                                                "SUMO's additional files: signal programmes, offsets, induction loops, "
                                                "types and routes")
                .only("kind", {"sumo"}),
        });
    return table;
}

const Table& signal_table() {
    static const Table table = make_table<SignalSettings>(
        "the fixed-time signal: red, then green, yellow and red",
        {
            number<&SignalSettings::first_green_s>("first_green", "s", {0, 7200},
                                                   "start of the first green; red until then, so that a queue forms"),
            number<&SignalSettings::green_s>("green", "s", {0.1, 7200}, "green time"),
            number<&SignalSettings::cross_green_s>(
                "cross_green", "s", {0, 7200},
                "intersections: green time of the streets from south to north; 0 s: as "
                "green"),
            number<&SignalSettings::yellow_s>("yellow", "s", {0, 60},
                                              "yellow after green; where it is shorter than drivers need, who cannot "
                                              "stop any more goes on on red"),
            number<&SignalSettings::all_red_s>("all_red", "s", {0, 600}, "all approaches red after yellow"),
            number<&SignalSettings::offset_s>("offset", "s", {0, 7200},
                                              "of a grid: green starts later by this for each column to the east and "
                                              "row to the north"),
            number<&SignalSettings::cycle_s>("cycle", "s", {0, 14'400},
                                             "single light: from one green to the next; 0 s: a single green, then red"),
        },
        check_signal);
    return table;
}

const Table& demand_table() {
    static const Table table = make_table<DemandSettings>(
        "the traffic that enters",
        {
            choice<&DemandSettings::kind>("kind", {"queue", "saturated", "rate"},
                                          "queue: `vehicles` a lane enter as soon as there is room, then none; "
                                          "saturated: inlets never run dry; rate: `inflow` an arm"),
            texts<&DemandSettings::arms>("arms", TextField::Rule::name, {0, 1000},
                                         "where vehicles enter: how the names of lanes to an intersection begin, such "
                                         "as south or c1r0_south, also between two intersections; none: wherever the "
                                         "network begins")
                .fallback("[]"),
            whole<&DemandSettings::vehicles>("vehicles", {1, 100'000}, "vehicles a lane").only("kind", {"queue"}),
            number<&DemandSettings::inflow_1ps>("inflow", "veh/h", {1, 100'000},
                                                "vehicles that arrive on an arm, evenly in time and over its lanes")
                .only("kind", {"rate"}),
            number<&DemandSettings::cross_inflow_1ps>("cross_inflow", "veh/h", {0, 100'000},
                                                      "the same of arms from south and north, though all others are "
                                                      "saturated; 0 veh/h: saturated as those")
                .only("kind", {"saturated"}),
            number<&DemandSettings::entry_speed_mps>("entry_speed", "km/h", {0, 150}, "speed on entering"),
            number<&DemandSettings::right>(
                "right", "%", {0, 100},
                "turning right, of the vehicles on each lane that leads right and elsewhere, not of all; with left at "
                "most 100 % of a lane that leads to both sides, and in proportion to left where that does not lead "
                "straight on"),
            number<&DemandSettings::left>("left", "%", {0, 100},
                                          "turning left, likewise of the vehicles on each lane that leads left and "
                                          "elsewhere"),
            choice<&DemandSettings::cross_turns>("cross_turns", {"alike", "own"},
                                                 "turns from streets from south to north; alike: as right and left"),
            number<&DemandSettings::cross_right>("cross_right", "%", {0, 100}, "turning right from those streets")
                .only("cross_turns", {"own"}),
            number<&DemandSettings::cross_left>("cross_left", "%", {0, 100}, "turning left from those streets")
                .only("cross_turns", {"own"}),
            choice<&DemandSettings::order>("order", {"balanced", "random"},
                                           "order of the turns; balanced: shares hold in every 20 vehicles of a lane"),
            choice<&DemandSettings::start>(
                "start", {"empty", "queued"},
                "what is on the approaches at first; queued: standing vehicles from the stop "
                "line to the entry"),
        });
    return table;
}

}  // namespace stopline

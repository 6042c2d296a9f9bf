// Fields of the network, the signal and the demand.
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "network/generators/street_checks.h"
#include "scenario/schema/field_rows.h"
#include "scenario/schema/fields.h"
#include "signals/signal_controller.h"

namespace stopline {
namespace {

const Table& approach_table() {
    static const Table table = make_table<ApproachSettings>(
        "a straight road with one stop line",
        {
            whole_number<&ApproachSettings::lanes>("lanes", {1, 16}, "number of parallel lanes"),
            number<&ApproachSettings::length_m>("length", "m", {10, 20'000},
                                                "distance from the entry to the stop line"),
            number<&ApproachSettings::exit_length_m>("exit_length", "m", {10, 20'000},
                                                     "distance from the stop line to the end of the road"),
            number<&ApproachSettings::speed_limit_mps>("speed_limit", "km/h", {5, 150}, "speed limit"),
            number<&ApproachSettings::gradient>("gradient", "%", {-20, 20}, "slope, positive uphill"),
        });
    return table;
}

const Table& lane_movements_table() {
    using L = IntersectionSettings::LaneMovements;
    static const Table table = make_table<L>(
        "a lane of an approach",
        {choice<&L::movements>("movements", lane_movements(), "movements that the lane allows").required()});
    return table;
}

const Table& intersection_table() {
    using S = IntersectionSettings;
    static const Table table = make_table<S>(
        "an intersection with four equal legs at right angles",
        {
            list<&S::lanes>("lanes", lane_movements_table, {1, 6}, "lanes of each approach, from left to right")
                .fallback("[{movements: straight+left}, {movements: straight+right}]"),
            number<&S::radius_m>("radius", "m", {5, 100}, "distance from the centre to the stop line"),
            number<&S::approach_length_m>("approach_length", "m", {50, 20'000},
                                          "distance from the network entry to the stop line"),
            number<&S::exit_length_m>("exit_length", "m", {20, 20'000},
                                      "distance from the intersection to the end of the road"),
            number<&S::lane_width_m>("lane_width", "m", {2, 6}, "width of a lane"),
            number<&S::speed_limit_mps>("speed_limit", "km/h", {5, 150}, "speed limit"),
            number<&S::turn_speed_mps>("turn_speed", "m/s", {1, 40}, "speed on turning connections"),
            number<&S::clearance_m>(
                "clearance", "m", {1, 5},
                "two vehicles touch if their centre lines are nearer than this; at most lane_width - 0.5 m"),
        },
        [](const S& s, Checker& check) {
            const std::string touching = clearance_problem(s.clearance_m, s.lane_width_m);
            if (!touching.empty()) check.error("clearance", touching);
            const double half_m = static_cast<double>(s.lanes.size()) * s.lane_width_m;
            if (half_m + s.clearance_m > s.radius_m) {
                check.error("radius",
                            "the lanes of a leg need at least " + short_text(half_m + s.clearance_m, unit("m")));
            }
        });
    return table;
}

const Table& grid_table() {
    using S = GridSettings;
    static const Table table = make_table<S>(
        "a grid of equal intersections",
        {
            whole_number<&S::columns>("columns", {1, 200}, "number of streets that run from south to north"),
            whole_number<&S::rows>("rows", {1, 200}, "number of streets that run from west to east"),
            number<&S::column_spacing_m>("column_spacing", "m", {50, 10'000},
                                         "distance between intersection centres from west to east"),
            number<&S::row_spacing_m>("row_spacing", "m", {50, 10'000},
                                      "distance between intersection centres from south to north"),
            choice<&S::shape>(
                "shape", {"rectangle", "without_corners"},
                "without_corners: the four corner intersections are left out; 3 x 3 is then one intersection with four "
                "neighbours"),
        },
        [](const S& s, Checker& check) {
            if (!s.has_corners() && (s.columns < 3 || s.rows < 3)) {
                check.error("shape", "without_corners needs at least 3 columns and 3 rows");
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
        "the road network",
        {
            choice<&NetworkSettings::kind>("kind", {"approach", "intersection", "grid", "streets", "sumo"},
                                           "kind of network; sumo: imported from SUMO's files"),
            section<&NetworkSettings::approach>("approach", approach_table, "straight road with one stop line")
                .only_if("kind", {"approach"}),
            section<&NetworkSettings::intersection>("intersection", intersection_table,
                                                    "layout of an intersection, single or in a grid")
                .only_if("kind", {"intersection", "grid"}),
            section<&NetworkSettings::grid>("grid", grid_table, "arrangement of the grid").only_if("kind", {"grid"}),
            section<&NetworkSettings::streets>("streets", streets_table, "streets with signalised intersections",
                                               "berlin")
                .required()
                .only_if("kind", {"streets"}),
            text<&NetworkSettings::net>("net", TextField::Rule::title,
                                        "SUMO network file, plain or gzipped, relative to the folder of the scenario")
                .required()
                .only_if("kind", {"sumo"}),
            texts<&NetworkSettings::routes>("routes", TextField::Rule::title, {0, 1000},
                                            "SUMO route files with vehicles, trips, flows and vehicle types")
                .only_if("kind", {"sumo"}),
            texts<&NetworkSettings::additional>(
                "additional", TextField::Rule::title, {0, 1000},
                "SUMO additional files with signal programmes, offsets, induction loops, "
                "vehicle types and routes")
                .only_if("kind", {"sumo"}),
            choice<&NetworkSettings::vehicles>(
                "vehicles", {"from_scenario", "from_routes"},
                "source of the driving behaviour; from_routes: the vehicle types in SUMO's files give maxSpeed, accel and "
                "decel, and for policies with the law constant_time also tau, minGap and (mesoscale mode) sigma; "
                "from_scenario: only lengths come from SUMO's files")
                .only_if("kind", {"sumo"}),
        });
    return table;
}

namespace {

// Adds a row for each parameter of the signal controllers.
template <std::size_t... Index>
void add_controller_parameters(std::index_sequence<Index...> /*indices*/, std::vector<Row<SignalSettings>>& rows) {
    const std::vector<SignalParameter> parameters = signal_parameters();
    const auto add = [&]<std::size_t k>() {
        if (k >= parameters.size()) return;
        const SignalParameter& parameter = parameters[k];
        std::vector<std::string> controllers;
        for (const SignalController* controller : signal_controllers()) {
            for (const SignalParameter& one : controller->parameters) {
                if (std::string_view(one.name) == parameter.name) controllers.emplace_back(controller->name);
            }
        }
        rows.push_back(number_at<&SignalSettings::parameters, k>(parameter.name, parameter.unit,
                                                                 {parameter.min, parameter.max}, parameter.meaning)
                           .fallback(parameter.fallback)
                           .only_if("controller", controllers));
    };
    (add.template operator()<Index>(), ...);
}

std::vector<Row<SignalSettings>> signal_rows() {
    std::vector<Row<SignalSettings>> rows{
        choice<&SignalSettings::controller>("controller", signal_controller_names(),
                                            "signal controller; fixed_time: the lights follow a programme"),
        number<&SignalSettings::first_green_s>(
            "first_green", "s", {0, 7200},
            "start of the first green; before it the signal is red, so that a queue forms"),
        number<&SignalSettings::green_s>("green", "s", {0.1, 7200}, "green time"),
        number<&SignalSettings::cross_green_s>(
            "cross_green", "s", {0, 7200},
            "intersections: green time of the streets from south to north; 0 s: same as green"),
        number<&SignalSettings::yellow_s>("yellow", "s", {0, 60},
                                          "yellow time; if it is too short, a vehicle that cannot stop enters on red "
                                          "(forced red entry)"),
        number<&SignalSettings::all_red_s>("all_red", "s", {0, 600}, "all-red time after yellow"),
        number<&SignalSettings::offset_s>(
            "offset", "s", {0, 7200},
            "grid: delay of the start of green from each column to the next one eastwards, and from each row to "
            "the next one northwards"),
        number<&SignalSettings::cycle_s>("cycle", "s", {0, 14'400},
                                         "single light: time from one green to the next; 0 s: one green only"),
    };
    add_controller_parameters(std::make_index_sequence<kMaxSignalParameters>(), rows);
    return rows;
}

}  // namespace

const Table& signal_table() {
    static const Table table = make_table<SignalSettings>("the signal: red first, then cycles of green, yellow and red",
                                                          signal_rows(), check_signal);
    return table;
}

const Table& demand_table() {
    static const Table table = make_table<DemandSettings>(
        "the traffic that enters the network",
        {
            choice<&DemandSettings::kind>(
                "kind", {"queue", "saturated", "rate"},
                "queue: a fixed number of `vehicles` per lane enters; saturated: a vehicle is always "
                "waiting to enter; rate: vehicles arrive at the rate `inflow`"),
            texts<&DemandSettings::approaches>(
                "approaches", TextField::Rule::name, {0, 1000},
                "approaches where vehicles enter, such as south or c1r0_south (the beginning of the names of the "
                "lanes); an approach between two intersections is possible too; empty: all entries of the network")
                .fallback("[]")
                .renamed_from("arms"),
            whole_number<&DemandSettings::vehicles>("vehicles", {1, 100'000}, "number of vehicles per lane")
                .only_if("kind", {"queue"}),
            number<&DemandSettings::inflow_1ps>(
                "inflow", "veh/h", {1, 100'000},
                "arrival rate per approach; the arrivals are evenly spaced in time and spread evenly over the lanes")
                .only_if("kind", {"rate"}),
            number<&DemandSettings::cross_inflow_1ps>(
                "cross_inflow", "veh/h", {0, 100'000},
                "arrival rate per approach from south and north, while the others are saturated; "
                "0 veh/h: all are saturated")
                .only_if("kind", {"saturated"}),
            number<&DemandSettings::entry_speed_mps>("entry_speed", "km/h", {0, 150},
                                                     "speed at the entry, at most the speed limit"),
            number<&DemandSettings::right_share>(
                "right", "%", {0, 100},
                "share of right turns on each lane that allows right turns and another movement; on lanes with both "
                "turns, left + right is at most 100 %; on lanes with both turns and no straight movement, the ratio of "
                "left to right counts"),
            number<&DemandSettings::left_share>(
                "left", "%", {0, 100},
                "share of left turns on each lane that allows left turns and another movement; same rules as for "
                "right"),
            choice<&DemandSettings::cross_turns>(
                "cross_turns", {"same", "separate"},
                "turn shares of the streets from south to north; same: the fields right and left apply to all streets; "
                "separate: the fields cross_right and cross_left apply to these streets")
                .value_renamed("alike", "same")
                .value_renamed("own", "separate"),
            number<&DemandSettings::cross_right_share>(
                "cross_right", "%", {0, 100},
                "share of right turns on the streets from south to north; same rules as for right")
                .only_if("cross_turns", {"separate"}),
            number<&DemandSettings::cross_left_share>(
                "cross_left", "%", {0, 100},
                "share of left turns on the streets from south to north; same rules as for right")
                .only_if("cross_turns", {"separate"}),
            choice<&DemandSettings::order>(
                "order", {"balanced", "random"},
                "order of the turns; balanced: the shares hold in every 20 vehicles of a lane; random: each turn is "
                "drawn independently"),
            choice<&DemandSettings::start>(
                "start", {"empty", "queued"},
                "initial state; queued: stopped vehicles fill the approaches from the stop line to the entry"),
        });
    return table;
}

}  // namespace stopline

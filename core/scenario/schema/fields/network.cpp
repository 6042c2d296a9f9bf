// Fields of the network, the signal and the demand.
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenario/kinds/network_kind.h"
#include "scenario/schema/field_rows.h"
#include "scenario/schema/fields.h"
#include "signals/signal_controller.h"

namespace stopline {
namespace {

std::string seconds(double value) { return short_text(value, unit("s")); }

void check_signal(const SignalSettings& signal, Checker& check) {
    const double shortest = signal.green_s + signal.yellow_s + signal.all_red_s;
    if (signal.cycle_s != 0.0 && signal.cycle_s < shortest && !signal.has_phases()) {
        check.error("cycle", "a cycle of " + seconds(signal.cycle_s) + " is shorter than green + yellow + all red = " +
                                 seconds(shortest) + " (write 0 s for a single green)");
    }
}

// Returns the field `kind` and the fields of all kinds of networks. Kinds can share a field.
std::vector<Row<NetworkSettings>> network_rows() {
    std::vector<Row<NetworkSettings>> rows{
        choice<&NetworkSettings::kind>("kind", kinds_with([](const NetworkKind& /*kind*/) { return true; }),
                                       "kind of network; sumo: imported from SUMO's files")};
    for (const NetworkKind* kind : network_kinds()) {
        for (Row<NetworkSettings>& row : kind->fields()) {
            const auto known = std::find_if(rows.begin(), rows.end(),
                                            [&](const auto& one) { return one.field.name == row.field.name; });
            if (known == rows.end()) {
                rows.push_back(std::move(row).only_if("kind", {kind->name}));
            } else {
                known->field.condition_values.emplace_back(kind->name);
            }
        }
    }
    return rows;
}

}  // namespace

const Table& network_table() {
    static const Table table = make_table<NetworkSettings>("the road network", network_rows());
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

const Table& phase_table() {
    using S = PhaseSettings;
    static const Table table = make_table<S>(
        "a phase: the movements with green, then yellow for those that lose green, then red for all of these",
        {
            texts<&S::protected_movements>(
                "protected", TextField::Rule::name, {0, 12},
                "movements with a protected green, named by side and turn, such as west_left; no two of them conflict")
                .fallback("[]"),
            texts<&S::permissive_movements>(
                "permissive", TextField::Rule::name, {0, 12},
                "movements with a permissive green: they yield to conflicting movements with a protected green; among "
                "themselves, left turns yield to right turns, and both yield to straight traffic")
                .fallback("[]"),
            number<&S::green_s>("green", "s", {0.1, 7200},
                                "green time; a phase without movements (pedestrians) takes its green, yellow and "
                                "all-red times, too")
                .required(),
            number<&S::yellow_s>("yellow", "s", {0, 60}, "yellow time"),
            number<&S::all_red_s>("all_red", "s", {0, 600}, "red time between the yellow and the next phase"),
            number<&S::min_green_s>("min_green", "s", {0.1, 7200}, "controllers that react to traffic: minimum green"),
            number<&S::max_green_s>(
                "max_green", "s", {0, 7200},
                "controllers that react to traffic: maximum green, from the first call of another phase; 0 s: same as "
                "green"),
            number<&S::gap_s>("gap", "s", {0.1, 60},
                              "controllers that react to traffic: green ends when no detector of the phase has been "
                              "occupied for this time (unit extension)"),
            choice<&S::recall>(
                "recall", {"off", "minimum", "maximum"},
                "controllers that react to traffic; minimum: the phase is served in each cycle; maximum: "
                "it is served in each cycle for its maximum green"),
            whole_number<&S::ring>("ring", {1, 2}, "controller dual_ring: ring of the phase"),
            whole_number<&S::barrier>("barrier", {1, 2},
                                      "controller dual_ring: phases of both rings with the same number run together"),
            choice<&S::dual_entry>("dual_entry", {"off", "on"},
                                   "controller dual_ring: the phase is served without a call if the other "
                                   "ring has a call for the same barrier"),
            choice<&S::coordinated>("coordinated", {"off", "on"},
                                    "controller dual_ring with signal.cycle: the green of this phase repeats with "
                                    "the cycle"),
        },
        [](const S& s, Checker& check) {
            if (s.min_green_s <= s.longest_green_s()) return;
            if (check.given("min_green")) {
                check.error("min_green", seconds(s.min_green_s) + " is longer than the maximum green, " +
                                             seconds(s.longest_green_s()));
            } else if (check.given("max_green")) {
                check.error("max_green", seconds(s.max_green_s) + " is shorter than the minimum green, " +
                                             seconds(s.min_green_s) + " (min_green)");
            }
        });
    return table;
}

const Table& phase_programme_table() {
    using S = ProgrammeSettings;
    static const Table table = make_table<S>(
        "a programme of phases, in force until the next programme begins",
        {
            number<&S::from_s>("from", "h", {0, 23.99}, "time of day at which the programme comes into force")
                .required(),
            list<&S::phases>("phases", phase_table, {1, 32}, "phases in the order of their greens").required(),
        });
    return table;
}

std::vector<Row<SignalSettings>> signal_rows() {
    std::vector<Row<SignalSettings>> rows{
        choice<&SignalSettings::controller>("controller", signal_controller_names(),
                                            "signal controller; fixed_time: the lights follow a programme; actuated: "
                                            "greens end at gaps in the traffic; dual_ring: actuated phases in two "
                                            "rings (NEMA); external: your Python code chooses the phases"),
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
                                         "single light: time from one green to the next; 0 s: one green only; "
                                         "controller dual_ring: background cycle of the coordination; 0 s: none"),
        list<&SignalSettings::phases>(
            "phases", phase_table, {0, 32},
            "intersections and grids: phases in the order of their greens; they replace green, cross_green, yellow and "
            "all_red; a movement with green in two successive phases keeps its green between them")
            .fallback("[]"),
        list<&SignalSettings::programmes>(
            "programmes", phase_programme_table, {0, 24},
            "intersections and grids: several programmes by time of day, instead of `phases`; a programme begins at the "
            "end of the cycle in which it comes into force")
            .fallback("[]"),
        number<&SignalSettings::clock_s>("clock", "h", {0, 23.99},
                                         "time of day at the start of the run, for `programmes`"),
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

namespace {

const Table& profile_table() {
    using S = ProfilePoint;
    static const Table table = make_table<S>(
        "a point of the profile of the arrival rate over time",
        {
            number<&S::from_s>("from", "min", {0, 20'000}, "time since the start of the run").required(),
            number<&S::inflow>("inflow", "%", {0, 1000}, "arrival rate from this time on, in percent of `inflow`")
                .required(),
        });
    return table;
}

void check_profile(const DemandSettings& demand, Checker& check) {
    for (std::size_t k = 0; k < demand.profile.size(); ++k) {
        const std::string field = "profile[" + std::to_string(k) + "].from";
        const double from_s = demand.profile[k].from_s;
        if (k == 0 && from_s != 0.0) {
            check.error(field, "the profile must begin at 0 min, not at " + short_text(from_s, unit("min")));
        } else if (k > 0 && from_s <= demand.profile[k - 1].from_s) {
            check.error(field, "value " + short_text(from_s, unit("min")) + " must be above the time before, " +
                                   short_text(demand.profile[k - 1].from_s, unit("min")));
        }
    }
}

void check_demand(const DemandSettings& demand, Checker& check) {
    check_profile(demand, check);
    const bool comes_from_file = demand.kind == "counts" || demand.kind == "od";
    if (comes_from_file && demand.start == "queued") {
        check.error("start", "value 'queued' is not possible with kind " + demand.kind +
                                 ": the vehicles of the file enter an empty network");
    }
    if (demand.kind != "od") return;
    for (const char* const field : {"right", "left", "cross_turns"}) {
        if (check.given(field)) check.error(field, "has no effect with kind od: the matrix determines the routes");
    }
}

using DemandRows = std::vector<Row<DemandSettings>>;

DemandRows arrival_rows() {
    return {
        choice<&DemandSettings::kind>(
            "kind", {"queue", "saturated", "rate", "counts", "od"},
            "queue: a fixed number of `vehicles` per lane enters; saturated: a vehicle is always "
            "waiting to enter; rate: vehicles arrive at the rate `inflow`; counts: the vehicles of a file with "
            "detector counts arrive; od: the vehicles of an origin-destination matrix arrive and follow the "
            "shortest routes"),
        texts<&DemandSettings::approaches>(
            "approaches", TextField::Rule::name, {0, 1000},
            "approaches where vehicles enter, such as south or c1r0_south (the beginning of the names of the "
            "lanes); an approach between two intersections is possible too; empty: all entries of the network")
            .fallback("[]")
            .renamed_from("arms")
            .only_if("kind", {"queue", "saturated", "rate"}),
        whole_number<&DemandSettings::vehicles>("vehicles", {1, 100'000}, "number of vehicles per lane")
            .only_if("kind", {"queue"}),
        number<&DemandSettings::inflow_1ps>("inflow", "veh/h", {1, 100'000},
                                            "arrival rate per approach; the arrivals are spread evenly over the lanes")
            .only_if("kind", {"rate"}),
        choice<&DemandSettings::arrivals>(
            "arrivals", {"even", "poisson", "platooned"},
            "process of arrivals on each lane; even: no scatter; poisson: exponential headways; platooned: platoons "
            "with exponential gaps between them (Cowan's model M3)")
            .only_if("kind", {"rate", "counts", "od"}),
        number<&DemandSettings::platoon_size>("platoon_size", "", {1, 1000},
                                              "mean number of vehicles in a platoon; the sizes are geometric")
            .only_if("arrivals", {"platooned"}),
        number<&DemandSettings::platoon_headway_s>("platoon_headway", "s", {0.1, 60}, "headway within a platoon")
            .only_if("arrivals", {"platooned"}),
        list<&DemandSettings::profile>("profile", profile_table, {0, 10'000}, "arrival rate over time; empty: constant")
            .fallback("[]")
            .only_if("kind", {"rate"}),
        choice<&DemandSettings::profile_shape>(
            "profile_shape", {"steps", "linear"},
            "steps: the rate is constant until the next point of the profile; linear: it changes linearly")
            .only_if("kind", {"rate"}),
        text<&DemandSettings::counts>(
            "counts", TextField::Rule::title,
            "CSV file with the columns begin, end, approach, vehicles and, optionally, left, straight, right; "
            "relative to the folder of the scenario")
            .required()
            .only_if("kind", {"counts"}),
        text<&DemandSettings::od>("od", TextField::Rule::title,
                                  "CSV file with the columns begin, end, origin, destination, vehicles; relative to "
                                  "the folder of the scenario")
            .required()
            .only_if("kind", {"od"}),
        number<&DemandSettings::scale>("scale", "%", {0.1, 10'000}, "factor of all arrivals")
            .only_if("kind", {"rate", "counts", "od"}),
        number<&DemandSettings::cross_inflow_1ps>(
            "cross_inflow", "veh/h", {0, 100'000},
            "arrival rate per approach from south and north, while the others are saturated; "
            "0 veh/h: all are saturated")
            .only_if("kind", {"saturated"}),
    };
}

DemandRows turn_rows() {
    return {
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
    };
}

DemandRows demand_rows() {
    DemandRows rows = arrival_rows();
    rows.push_back(number<&DemandSettings::entry_speed_mps>("entry_speed", "km/h", {0, 150},
                                                            "speed at the entry, at most the speed limit"));
    const DemandRows turns = turn_rows();
    rows.insert(rows.end(), turns.begin(), turns.end());
    rows.push_back(choice<&DemandSettings::start>(
        "start", {"empty", "queued"},
        "initial state; queued: stopped vehicles fill the approaches from the stop line to the entry"));
    return rows;
}

}  // namespace

const Table& demand_table() {
    static const Table table =
        make_table<DemandSettings>("the traffic that enters the network", demand_rows(), check_demand);
    return table;
}

}  // namespace stopline

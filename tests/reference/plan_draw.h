// Random plans for the comparison of core/sim with the reference engine.
#pragma once

#include <algorithm>
#include <random>

#include "base/input_error.h"
#include "reference/plan.h"

namespace stopline::reference_engine {

// An imported network of tests/data, with the first and last edges of its trips.
struct ImportedNet {
    std::string file;
    std::vector<std::pair<std::string, std::string>> trips;
};

// Returns trips from each side of a four-way junction to each other side.
inline std::vector<std::pair<std::string, std::string>> four_way_trips() {
    std::vector<std::pair<std::string, std::string>> trips;
    for (const std::string from : {"n", "e", "s", "w"}) {
        for (const std::string to : {"n", "e", "s", "w"}) {
            if (from != to) trips.emplace_back(from + "i", to + "o");
        }
    }
    return trips;
}

inline std::vector<std::pair<std::string, std::string>> roundabout_trips() {
    std::vector<std::pair<std::string, std::string>> trips;
    for (const std::string from : {"i0", "i1", "i2", "i3"}) {
        for (const std::string to : {"x0", "x1", "x2", "x3"}) {
            if (from[1] != to[1]) trips.emplace_back(from, to);
        }
    }
    return trips;
}

// Draws random plans. If a call needs several random numbers, each is drawn in a statement of its own. Reason: the
// order in which arguments are evaluated depends on the compiler.
class PlanDraw {
public:
    explicit PlanDraw(std::uint64_t seed) : random_(seed) {}

    // A straight road with a light.
    Plan mesoscale() {
        Plan p = road_and_signal();
        p.meso = one_of({"table2", "fitted", "passages", "start", "start_passages"});
        p.step_s = chance(50) ? 0.1 : chance(50) ? 0.05 : 0.2;
        p.duration_s = number(30, 110);
        if (chance(30)) p.dawdling = number(0, 8) / 10.0;
        add_demand(p, 14);
        return p;
    }

    Plan full_dynamics() {
        Plan p = road_and_signal();
        p.step_s = chance(20) ? 0.02 : 0.01;
        p.duration_s = number(15, 45);
        p.first_green_s = number(0, 8);
        if (chance(40)) p.radar_delay_ms = number(0, 50) * 5.0;
        if (chance(40)) p.v2v_delay_ms = 20.0 + number(0, 60);
        if (chance(25)) p.gradient_percent = number(-6, 6);
        add_demand(p, 7);
        return p;
    }

    // Two streets that cross. Short clearance times make vehicles of both streets meet.
    Plan crossing(bool is_mesoscale) {
        Plan p = is_mesoscale ? mesoscale() : full_dynamics();
        p.roads = Plan::Roads::intersection;
        p.movements = {"straight"};
        p.lanes = 1;
        p.gradient_percent = 0.0;
        p.keeps_clear = chance(50);
        // At 3 km/h, the exit lanes count as jammed.
        p.exit_limit_kmh = chance(40) ? 3.0 : 0.0;
        p.length_m = std::max(p.length_m, 50.0);
        p.green_s = number(3, 50) / 5.0;
        p.yellow_s = number(0, 10) / 5.0;
        p.all_red_s = number(0, 8) / 5.0;
        fit_duration(p);
        return p;
    }

    // An intersection with turns. Left turns yield to the oncoming traffic.
    Plan turns(bool is_mesoscale) {
        Plan p = crossing(is_mesoscale);
        static const std::vector<std::vector<std::string>> kMovements{{"straight+left+right"},
                                                                      {"straight+left", "straight+right"},
                                                                      {"left", "straight+right"},
                                                                      {"straight+left+right"},
                                                                      {"left", "straight", "right"}};
        p.movements = kMovements[static_cast<std::size_t>(number(0, static_cast<int>(kMovements.size()) - 1))];
        // A turn share needs a lane that allows the turn and another movement.
        const auto has_choice = [&](const std::string& turn) {
            return std::any_of(p.movements.begin(), p.movements.end(), [&](const std::string& lane) {
                return lane.find(turn) != std::string::npos && lane.find('+') != std::string::npos;
            });
        };
        if (has_choice("left")) p.left_percent = number(1, 10) * 5.0;
        if (has_choice("right")) p.right_percent = number(0, 8) * 5.0;
        p.exit_limit_kmh = chance(25) ? 3.0 : 0.0;
        p.keeps_clear = chance(60);
        if (chance(60)) p.green_s = number(25, 100) / 5.0;
        if (chance(30)) draw_critical_gap(p);
        p.duration_s = is_mesoscale ? number(40, 110) : number(25, 45);
        fit_duration(p);
        return p;
    }

    // Platoons of limited length.
    Plan mini_platoons() {
        const bool turns_off = chance(40);
        Plan p = turns_off ? turns(true) : chance(50) ? lane_changes(true) : mesoscale();
        p.max_platoon = number(1, 5);
        p.components = {{"CDG", 100.0}};
        if (chance(40)) p.components = {{"CDG", 70.0}, {one_of({"CTG-Ref", "SWITCH-1"}), 30.0}};
        return p;
    }

    // Human drivers and vehicles of several types.
    Plan mixed_fleet(bool is_mesoscale) {
        for (;;) {
            const Plan p = any_fleet(is_mesoscale);
            try {
                scenario_of(p);
                return p;
            } catch (const InputError&) {
                continue;  // some fleets are refused, such as lorries with short gaps
            }
        }
    }

    // Streets with one or two intersections, several lanes and turn pockets.
    Plan lane_changes(bool is_mesoscale) {
        Plan p = is_mesoscale ? mesoscale() : full_dynamics();
        p.roads = Plan::Roads::streets;
        p.lanes = 1;
        p.gradient_percent = 0.0;
        p.exit_limit_kmh = 0.0;
        p.limit_kmh = 50.0;
        p.entry_kmh = std::min(p.entry_kmh, 50.0);
        p.demand = one_of({"queue", "saturated"});
        p.vehicles = number(3, is_mesoscale ? 15 : 6);
        p.keeps_clear = chance(60);
        if (chance(30)) p.gap_share_percent = number(4, 12) * 10.0;
        if (chance(25)) p.politeness = number(1, 10) / 10.0;
        if (chance(25)) p.keep_right_mps2 = number(1, 5) / 10.0;
        p.gap_opening = chance(75) ? "on" : "off";
        if (chance(50)) {
            p.streets = one_street(number(120, 260));
        } else {
            const int distance_m = number(90, 250);
            p.streets = two_streets(number(120, 220), distance_m);
        }
        p.duration_s = is_mesoscale ? number(40, 100) : number(25, 40);
        return p;
    }

    // Two equal intersections in a row, with a road between them.
    Plan grid(bool is_mesoscale) {
        Plan p = turns(is_mesoscale);
        p.roads = Plan::Roads::grid;
        p.spacing_m = number(12, 30) * 10.0;
        // The road between the intersections must suffice to stop.
        p.limit_kmh = std::min(p.limit_kmh, 50.0);
        p.entry_kmh = std::min(p.entry_kmh, p.limit_kmh);
        p.decision_mps2 = std::max(p.decision_mps2, 2.5);
        p.exit_limit_kmh = 0.0;
        if (p.demand == "rate") p.demand = "saturated";
        return p;
    }

    // Junctions of SUMO networks: minor roads, right before left, all-way stops, zippers, roundabouts and signals.
    Plan imported(bool is_mesoscale) {
        static const std::vector<ImportedNet> kNets{
            {"right_of_way/minor_road.net.xml", {{"ac", "cd"}, {"bc", "cd"}}},
            {"right_of_way/merge_signal.net.xml", {{"ac", "cd"}, {"bc", "cd"}}},
            {"right_of_way/zipper.net.xml", {{"ab", "bc"}}},
            {"right_of_way/full_exit.net.xml", {{"wc", "me"}, {"wc", "cn"}, {"sc", "me"}, {"sc", "cn"}}},
            {"right_of_way/right_before_left.net.xml", four_way_trips()},
            {"right_of_way/all_way_stop.net.xml", four_way_trips()},
            {"right_of_way/all_way_stop.net.xml", four_way_trips()},
            {"right_of_way/one_lane_roundabout.net.xml", roundabout_trips()},
            {"left_turns.net.xml", four_way_trips()},
            {"wrong_turn_lane.net.xml", four_way_trips()},
            {"roundabout.net.xml", roundabout_trips()},
            {"three_lanes.net.xml", {{"ab", "bc"}}},
            {"fast_lane_drop.net.xml", {{"ab", "cd"}}},
            {"short_edges.net.xml", {{"e0", "e14"}}},
            {"crawling_exit.net.xml",
             {{"nc", "cs"}, {"nc", "me"}, {"sc", "me"}, {"sc", "cn"}, {"wc", "cs"}, {"wc", "me"}, {"wc", "cn"}}},
            {"short_exit.net.xml",
             {{"wc", "de"}, {"wc", "dn"}, {"wc", "cs"}, {"nc", "cs"}, {"nc", "de"}, {"sd", "de"}, {"sd", "dn"}}},
            {"short_weave.net.xml", {{"in", "straight"}, {"in", "right"}}},
            {"speed_drop.net.xml", {{"ab", "bc"}}},
            {"lights_grid.net.xml",
             {{"left0A0", "B1right1"},
              {"left0A0", "A1top0"},
              {"top1B1", "A0bottom0"},
              {"right1B1", "A1left1"},
              {"bottom1B0", "A1left1"},
              {"right0B0", "A1top0"}}},
        };
        const ImportedNet& net = kNets[static_cast<std::size_t>(number(0, static_cast<int>(kNets.size()) - 1))];
        Plan p = is_mesoscale ? mesoscale() : full_dynamics();
        p.roads = Plan::Roads::imported;
        p.net = net.file;
        p.lanes = 1;
        p.exit_limit_kmh = 0.0;
        p.gradient_percent = 0.0;
        p.starts_queued = false;
        p.keeps_clear = chance(50);
        if (chance(30)) draw_critical_gap(p);
        p.duration_s = is_mesoscale ? number(50, 110) : number(30, 50);
        const int count = is_mesoscale ? number(4, 40) : number(3, 14);
        std::vector<double> departures_s;
        for (int k = 0; k < count; ++k) departures_s.push_back(number(0, static_cast<int>(6.0 * p.duration_s)) / 10.0);
        std::sort(departures_s.begin(), departures_s.end());
        for (const double depart_s : departures_s) {
            const auto& [from, to] =
                net.trips[static_cast<std::size_t>(number(0, static_cast<int>(net.trips.size()) - 1))];
            p.trips.push_back({depart_s, from, to, one_of({"max", "max", "0", "8", "last"}), one_of({"best", "free"})});
        }
        return p;
    }

private:
    int number(int from, int to) { return from + static_cast<int>(random_() % static_cast<unsigned>(to - from + 1)); }
    bool chance(int percent) { return number(1, 100) <= percent; }
    std::string one_of(const std::vector<std::string>& names) {
        return names[static_cast<std::size_t>(number(0, static_cast<int>(names.size()) - 1))];
    }

    // Returns the sum of three times that are multiples of 0.1 s. Removes the rounding errors of the addition.
    static double sum(double a_s, double b_s, double c_s) { return std::round(10.0 * (a_s + b_s + c_s)) / 10.0; }

    // Draws a critical gap in steps of 0.5 s. With an odd number of half seconds, also sets a critical lag of 75 % of
    // it.
    void draw_critical_gap(Plan& p) {
        const int half_seconds = number(4, 16);
        p.critical_gap_s = half_seconds / 2.0;
        if (half_seconds % 2 == 1) p.critical_lag_s = 0.75 * p.critical_gap_s;
    }

    // The run of an intersection must include a whole cycle.
    static void fit_duration(Plan& p) {
        const double cycle_s = 2.0 * (p.green_s + p.yellow_s + p.all_red_s);
        p.duration_s = std::ceil(std::max(p.duration_s, p.first_green_s + cycle_s + 1.0));
    }

    Plan any_fleet(bool is_mesoscale) {
        const int kind = number(1, 10);
        Plan p = kind <= 3      ? turns(is_mesoscale)
                 : kind <= 5    ? lane_changes(is_mesoscale)
                 : kind <= 7    ? imported(is_mesoscale)
                 : is_mesoscale ? mesoscale()
                                : full_dynamics();
        static const std::vector<std::string> kVehicles{
            "", "", "electric_100kw", "rigid_lorry_12t", "city_bus_12m", "articulated_lorry_35t"};
        p.components.clear();
        const int components = number(2, 3);
        for (int k = 0; k < components; ++k) {
            const double share_percent = k + 1 == components ? 100.0 - 30.0 * k : 30.0;
            Plan::Component component{one_of({"HUMAN", "HUMAN", "CDG", "CTG-Ref", "CTG-HCM", "IDM"}), share_percent};
            component.vehicle = one_of(kVehicles);
            if (component.vehicle == "city_bus_12m" || component.vehicle.find("lorry") != std::string::npos)
                component.driver = component.vehicle == "city_bus_12m" ? "bus" : "lorry";
            p.components.push_back(component);
        }
        // The drivers of all components must agree in the delays of their sensors.
        p.radar_delay_ms = 150.0;
        p.v2v_delay_ms = 20.0;
        p.stop_margin_m = 1.0;
        if (chance(40)) p.reaction_s = number(5, 15) / 10.0;
        if (chance(40)) p.gap_error = number(0, 20) / 100.0;
        p.length_m = std::max({p.length_m, 150.0, 25.0 * p.vehicles});
        return p;
    }

    Plan road_and_signal() {
        Plan p;
        p.seed = static_cast<std::uint64_t>(number(1, 1'000'000));
        p.length_m = number(60, 400);
        p.exit_m = number(30, 300);
        p.limit_kmh = chance(50) ? 50.0 : number(3, 10) * 10.0;
        if (chance(20)) p.exit_limit_kmh = number(2, 9) * 10.0;
        p.first_green_s = number(0, 125) / 5.0;
        p.green_s = number(10, 125) / 5.0;
        p.yellow_s = number(0, 20) / 5.0;
        p.cycle_s = chance(75) ? sum(p.green_s, p.yellow_s, number(10, 150) / 5.0) : 0.0;
        if (chance(30)) p.hesitation_s = number(1, 15) / 10.0;
        if (chance(20)) p.stop_margin_m = number(1, 40) / 10.0;
        if (chance(20)) p.stop_mps2 = number(15, 35) / 10.0;
        if (chance(20)) p.decision_mps2 = number(25, 60) / 10.0;
        p.vehicle = one_of({"petrol_eu4_72kw", "petrol_eu4_84kw", "diesel_eu4_103kw", "electric_100kw"});
        return p;
    }

    void add_demand(Plan& p, int most_vehicles) {
        p.lanes = chance(20) ? number(2, 3) : 1;
        p.demand = one_of({"queue", "queue", "saturated", "rate"});
        p.vehicles = number(1, most_vehicles);
        p.starts_queued = chance(p.demand == "rate" ? 10 : 25);
        p.entry_kmh = chance(70) ? p.limit_kmh : number(1, 5) * 10.0;
        p.inflow_vehph = number(2, 30) * 60.0;
        if (p.demand == "queue") p.length_m = std::max(p.length_m, 12.0 * p.vehicles + 1.0);
        if (p.demand == "saturated" || p.starts_queued) p.length_m = std::min(p.length_m, 15.0 * most_vehicles);
        // The length must suffice to stop from the entry speed.
        p.length_m = std::max(p.length_m, 20.0 + std::ceil(0.04 * p.entry_kmh * p.entry_kmh));
        add_policies(p);
    }

    void add_policies(Plan& p) {
        static const std::vector<std::string> kPolicies{"CDG",     "CDG-6m",   "CTG-Ref",     "CTG-HCM",
                                                        "CTG-HBS", "SWITCH-1", "SWITCH-1-6m", "SWITCH-2"};
        const int components = chance(50) ? 1 : number(2, 3);
        p.components.clear();
        for (int k = 0; k < components; ++k) {
            const double share_percent = k + 1 == components ? 100.0 - 30.0 * k : 30.0;
            p.components.push_back({one_of(kPolicies), share_percent});
        }
        if (chance(15)) p.components.front().policy = one_of({"PROGRESSIVE", "MEASURED"});
        p.pattern = one_of({"alternating", "random", "balanced"});
    }

    // Returns the legs of an intersection. The major street has two or three lanes, maybe with pockets.
    std::string legs(int length_m) {
        static const std::vector<std::string> kMajor{
            "{movements: straight+left}, {movements: straight+right}",
            "{movements: left, pocket: 40 m}, {movements: straight}, {movements: straight+right}",
            "{movements: left}, {movements: straight}, {movements: straight+right}",
            "{movements: straight+left}, {movements: straight}, {movements: right, pocket: 35 m}"};
        std::string text;
        for (const char* const from : {"west", "east"}) {
            const int right_percent = number(1, 9) * 5;
            const int left_percent = number(1, 9) * 5;
            text += fmt::format(
                "      - {{from: {}, lanes: [{}], exits: 2, left: {} %, right: {} %, length: {} m, exit_length: 60 m}}\n",
                from, one_of(kMajor), left_percent, right_percent, length_m);
        }
        for (const char* const from : {"north", "south"}) {
            const int minor_length_m = number(80, 150);
            const int right_percent = number(1, 4) * 10;
            const int left_percent = number(1, 4) * 10;
            text += fmt::format(
                "      - {{from: {}, lanes: [{{movements: straight+left+right}}], exits: 2, left: {} %, right: {} %, "
                "length: {} m, exit_length: 50 m}}\n",
                from, left_percent, right_percent, minor_length_m);
        }
        return text;
    }

    std::string programme() {
        const int protected_left_s = chance(50) ? 0 : 4;
        const int clearance_s = number(2, 5);
        return fmt::format(
            "      programme: {{major_green: {} s, major_yellow: 3 s, major_clearance: {} s, protected_left: {} s, "
            "minor_green: 8 s, minor_yellow: 3 s, minor_clearance: 3 s}}\n",
            number(6, 16), clearance_s, protected_left_s);
    }

    // Returns the YAML of a median of 4 m. If the length in metres is even, adds a passing clearance of 3.5 m.
    static std::string median(int length_m) {
        return std::string("    median: 4 m\n") + (length_m % 2 == 0 ? "    passing_clearance: 3.5 m\n" : "");
    }

    std::string one_street(int length_m) {
        const std::string times = programme();
        return median(length_m) + "    intersections:\n    - name: a\n" + times + "      legs:\n" + legs(length_m);
    }
    std::string two_streets(int length_m, int distance_m) {
        const std::string times = programme();
        const std::string legs_of_a = legs(length_m);
        const int offset_s = number(0, 20);
        return median(length_m) + "    intersections:\n    - name: a\n" + times + "      legs:\n" + legs_of_a +
               fmt::format("    - name: b\n      x: {} m\n      offset: {} s\n", distance_m, offset_s) + times +
               "      legs:\n" + legs(length_m);
    }

    std::mt19937_64 random_;
};

}  // namespace stopline::reference_engine

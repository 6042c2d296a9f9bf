// Descriptions of the columns in the tables of energy, comfort and safety, which all kinds of networks share.
#include <string>
#include <string_view>

#include "runs/tables/column_docs.h"
#include "scenario/kinds/network_kind.h"

namespace stopline {

namespace {

TableDoc energy_table_doc(std::string_view name) {
    return {
        name,
        "Written with `measure.energy: on`. One row for each vehicle that has entered. The mesoscale mode estimates "
        "the values.",
        {kPopulationColumn,
         kVehicleColumn,
         {"policy", "", "", "spacing policy of the vehicle"},
         {"entered_s", "s", "run", "time of the entry into the network"},
         {"left_s", "s", "run", "time at which the vehicle leaves the network; empty: still there at the end"},
         {"distance_m", "m", "run", "driven distance"},
         {"stops", "", "run",
          "stops, including a standstill at entry; the next stop counts only after a speed above 5 km/h"},
         {"idle_s", "s", "run", "time for which the vehicle is stopped"},
         {"fuel_g", "g", "run", "fuel; empty: electric vehicle"},
         {"co2_g", "g", "run", "CO2 from this fuel"},
         {"energy_Wh", "Wh", "run", "energy from the battery, less recuperation; empty: vehicle with an engine"},
         {"driven_Wh", "Wh", "run", "positive work at the wheels"},
         {"overrun_Wh", "Wh", "run", "work that engine drag or recuperation absorbs; 0 or below"},
         {"brake_Wh", "Wh", "run", "work of the friction brakes"},
         {"air_Wh", "Wh", "run", "work against air resistance"},
         {"rolling_Wh", "Wh", "run", "work against rolling resistance"}}};
}

TableDoc safety_table_doc(std::string_view name) {
    return {
        name,
        "Written with `measure.surrogate_safety: on`. One row for each bin that has samples. The "
        "first and the last\nbin of a distribution also hold all values beyond them.",
        {kPopulationColumn,
         {"measure", "", "",
          "`jerk_mps3`, `acceleration_mps2`, `time_to_collision_s`, `brake_threat`, `net_gap_m` or `time_gap_s`; see "
          "the columns of `summary.csv`"},
         {"from", "", "", "lower end of the bin, in the unit of the measure"},
         {"to", "", "", "upper end of the bin"},
         {"time_s", "veh s", "run", "time that vehicles spend in the bin"},
         {"share_percent", "%", "run", "share of this time in the time of all bins of the measure"}}};
}

}  // namespace

std::vector<TableDoc> driving_table_docs() {
    return {energy_table_doc("network/energy.csv"),      safety_table_doc("network/safety_distributions.csv"),
            energy_table_doc("intersection/energy.csv"), safety_table_doc("intersection/safety_distributions.csv"),
            energy_table_doc("single_light/energy.csv"), safety_table_doc("single_light/safety_distributions.csv")};
}

}  // namespace stopline

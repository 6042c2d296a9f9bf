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
         {"vehicle", "", "", "number of the vehicle"},
         {"policy", "", "", "spacing policy of the vehicle"},
         {"entered_s", "s", "run", "time of the entry into the network"},
         {"left_s", "s", "run", "time at which the vehicle leaves the network; empty: still there at the end"},
         {"distance_m", "m", "run", "driven distance"},
         {"stops", "", "run",
          "stops, including a standstill at entry; a further stop counts after a speed above 5 km/h"},
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

}  // namespace

std::vector<TableDoc> driving_table_docs() {
    return {energy_table_doc("network/energy.csv"), energy_table_doc("intersection/energy.csv"),
            energy_table_doc("single_light/energy.csv")};
}

}  // namespace stopline

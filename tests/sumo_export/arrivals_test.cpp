// Exported vehicles depart at their arrival times, also those that wait for room in the run of Stopline.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "scenario/scenario_text.h"
#include "sim/insertion/insert_vehicles.h"
#include "sim/step/simulation.h"
#include "sumo_export/edges.h"
#include "sumo_export/inputs.h"
#include "sumo_import/sumo_xml.h"

namespace stopline {
namespace {

TEST(SumoInputs, VehiclesDepartAtTheirArrivalTimes) {
    const Model model = build_model(
        parse_scenario(
            "{fidelity: meso, network: {kind: intersection, intersection: {approach_length: 100 m}}, signal: "
            "{first_green: 1 s, green: 15 s}, populations: [CTG-Ref], demand: {kind: rate, inflow: 1200 "
            "veh/h, arrivals: poisson, profile: [{from: 0 min, inflow: 100 %}, {from: 2 min, inflow: 0 %}]}}",
            "test.yaml"),
        0);
    const PlainNetwork network = plain_network(model.graph);
    const TemporaryFolder folder;
    const auto writer = make_sumo_route_writer(folder.path() / "v.rou.xml", model, network);
    Simulation simulation(model);
    while (simulation.time_s() < 600.0) {
        writer->observe(simulation.state());
        simulation.step();
    }
    writer->finish();
    ASSERT_EQ(insertion_backlog(model, simulation.state()), 0);
    ASSERT_GT(departure_delays(model, simulation.state()).max_s, 5.0) << "no vehicle had to wait";

    std::vector<double> arrivals_s;
    for (const DemandPlan::Inlet& inlet : model.demand.inlets) {
        arrivals_s.insert(arrivals_s.end(), inlet.arrivals_s.begin(), inlet.arrivals_s.end());
    }
    std::sort(arrivals_s.begin(), arrivals_s.end());
    std::vector<double> departures_s;
    const SumoXml xml(folder.path() / "v.rou.xml", {"routes"});
    for (const pugi::xml_node vehicle : xml.root().children("vehicle")) {
        departures_s.push_back(xml.number(vehicle, "depart"));
    }
    ASSERT_EQ(departures_s.size(), arrivals_s.size());
    ASSERT_GT(arrivals_s.size(), 100U);
    for (std::size_t k = 0; k < arrivals_s.size(); ++k) EXPECT_NEAR(departures_s[k], arrivals_s[k], 0.0051) << k;
}

}  // namespace
}  // namespace stopline

// Tests of reading SUMO route files: vehicles, flows, types, warnings and errors.
#include "sumo_import/sumo_routes.h"

#include <gtest/gtest.h>

#include <string>

#include "sumo_import/sumo_net.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

using testing::crossing_net;
using testing::refusal;
using testing::SumoFiles;
using testing::without_folder;

constexpr double kUntil_s = 100.0;

SumoTraffic read(const std::string& body, const std::string& additional = "") {
    const SumoFiles files;
    const SumoNetwork network = make_sumo_network(read_sumo_net(files.write("my.net.xml", crossing_net())), 2.0);
    SumoRouteFiles names;
    if (!additional.empty()) names.additional.push_back(files.write("my.add.xml", additional));
    names.routes.push_back(files.write("my.rou.xml", "<routes>\n" + body + "\n</routes>"));
    return read_sumo_routes(names, network, kUntil_s, 1);
}

TEST(SumoRoutes, SortsVehiclesByDeparture) {
    const SumoTraffic traffic = read(R"(<vType id="truck" vClass="truck"/>
<route id="straight" edges="w_in e_out"/>
<vehicle id="late" depart="5.5" route="straight" departLane="1" departSpeed="max"/>
<vehicle id="early" depart="0:00:02" type="truck" departLane="best" departSpeed="3"><route edges="w_in n_out"/></vehicle>
<trip id="third" depart="7" from="s_in" to="n_out"/>)");
    ASSERT_EQ(traffic.trips.size(), 3U);
    EXPECT_EQ(traffic.ids[0], "early");
    EXPECT_DOUBLE_EQ(traffic.trips[0].depart_s, 2.0);
    EXPECT_FLOAT_EQ(traffic.trips[0].length_m, 7.1F);
    EXPECT_FLOAT_EQ(traffic.trips[0].speed_mps, 3.0F);
    EXPECT_EQ(traffic.trips[0].depart_lane, Trip::DepartLane::best);
    EXPECT_EQ(traffic.trips[1].depart_lane, Trip::DepartLane::given);
    EXPECT_EQ(traffic.trips[1].lane, 0);  // counted from the left
    EXPECT_EQ(traffic.trips[1].depart_speed, Trip::DepartSpeed::limit);
    const auto turn = [&](int trip) {
        return traffic.turns[static_cast<std::size_t>(traffic.trips[static_cast<std::size_t>(trip)].first_turn)];
    };
    EXPECT_EQ(turn(0), Turn::left);
    EXPECT_EQ(turn(1), Turn::straight);
    EXPECT_EQ(turn(2), Turn::straight);
    EXPECT_DOUBLE_EQ(traffic.shortest_vehicle_m(), 5.0);
}

TEST(SumoRoutes, ReadsDepartPos) {
    const auto trip = [](const std::string& position) {
        return read("<trip id=\"t\" depart=\"0\" from=\"w_in\" to=\"e_out\" " + position + "/>").trips[0];
    };
    EXPECT_EQ(trip("").depart_position, Trip::DepartPosition::base);
    EXPECT_EQ(trip("departPos=\"base\"").depart_position, Trip::DepartPosition::base);
    EXPECT_EQ(trip("departPos=\"last\"").depart_position, Trip::DepartPosition::last);
    EXPECT_EQ(trip("departPos=\"random\"").depart_position, Trip::DepartPosition::random);
    EXPECT_EQ(trip("departPos=\"random_free\"").depart_position, Trip::DepartPosition::free);
    EXPECT_EQ(trip("departPos=\"-12.5\"").depart_position, Trip::DepartPosition::given);
    EXPECT_FLOAT_EQ(trip("departPos=\"-12.5\"").front_m, 177.5F);  // 12.5 m before the end of the 190 m
    EXPECT_FLOAT_EQ(trip("departPos=\"190\"").front_m, 190.0F);
}

// Returns a route file with the comment that a program of SUMO writes.
std::string written_by(const std::string& comment, const std::string& attributes) {
    return "<?xml version=\"1.0\"?>\n<!-- generated on 2026-01-31 by " + comment + "\n<configuration/>\n-->\n" +
           R"(<routes><trip id="t" depart="0" from="w_in" to="e_out" )" + attributes + "/></routes>";
}

SumoTraffic read_file(const std::string& routes, const std::string& net = crossing_net()) {
    const SumoFiles files;
    const SumoNetwork network = make_sumo_network(read_sumo_net(files.write("my.net.xml", net)), 2.0);
    return read_sumo_routes({{}, {files.write("my.rou.xml", routes)}}, network, kUntil_s, 1);
}

TEST(SumoRoutes, DepartureDefaultsFollowTheVersion) {
    constexpr auto best = Trip::DepartLane::best;
    constexpr auto rightmost = Trip::DepartLane::rightmost;
    constexpr auto mean = Trip::DepartSpeed::mean;
    constexpr auto given = Trip::DepartSpeed::given;
    const auto expect = [](const std::string& comment, Trip::DepartLane lane, Trip::DepartSpeed speed,
                           const std::string& note) {
        const SumoTraffic traffic = read_file(written_by(comment, ""));
        EXPECT_EQ(traffic.trips[0].depart_lane, lane) << comment;
        EXPECT_EQ(traffic.trips[0].depart_speed, speed) << comment;
        EXPECT_EQ(traffic.trips[0].speed_mps, 0.0F) << comment;
        ASSERT_EQ(traffic.notes.size(), 1U) << comment;
        EXPECT_EQ(without_folder(traffic.notes[0]), "my.rou.xml: " + note) << comment;
    };
    const std::string present = R"(departLane="best_prob" departSpeed="avg")";
    const std::string old = R"(departLane="first" departSpeed="0")";
    expect("Eclipse SUMO duarouter 1.28.0", best, mean,
           present + " (the defaults of SUMO 1.28, which wrote the route file)");
    expect("Eclipse SUMO duarouter 1.27.0", best, mean,
           present + " (the defaults of SUMO 1.27, which wrote the route file)");
    expect("Eclipse SUMO randomTrips.py v1.26.0", rightmost, given,
           old + " (the defaults of SUMO 1.26, which wrote the route file)");
    expect("Eclipse SUMO duarouter Version 1.4.0", rightmost, given,
           old + " (the defaults of SUMO 1.4, which wrote the route file)");
    expect("SUMO duarouter Version v0_32_0+0815-abc", rightmost, given,
           old + " (the defaults of SUMO 0.32, which wrote the route file)");
    expect("my own script 1.2", best, mean, present + " (the defaults since SUMO 1.27; the files name no version)");
}

TEST(SumoRoutes, DepartureDefaultsFollowTheNetworkIfTheRouteFileHasNoVersion) {
    const std::string routes = written_by("hand", "");
    const auto lane = [&](const std::string& from, const std::string& to) {
        return read_file(routes, testing::replaced(crossing_net(), from, to)).trips[0].depart_lane;
    };
    EXPECT_EQ(lane("<net", "<!-- generated by Eclipse SUMO netconvert 1.28.0 -->\n<net"), Trip::DepartLane::best);
    EXPECT_EQ(lane("<net", "<!-- generated by Eclipse SUMO netconvert 1.19.0 -->\n<net"), Trip::DepartLane::rightmost);
    // All releases of SUMO since 1.20 write version="1.20", so this version does not tell if the release had the old
    // defaults (up to 1.26) or the new ones (since 1.27). The new defaults apply.
    EXPECT_EQ(lane("<net version=\"1.20\"", "<net version=\"1.20\""), Trip::DepartLane::best);
    EXPECT_EQ(lane("<net version=\"1.20\"", "<net version=\"1.9\""), Trip::DepartLane::rightmost);
    EXPECT_EQ(lane("<net version=\"1.20\"", "<net"), Trip::DepartLane::best);
}

TEST(SumoRoutes, StatedDeparturesNeedNoDefaults) {
    const SumoTraffic traffic =
        read_file(written_by("Eclipse SUMO sumo 1.28.0", R"(departLane="random" departSpeed="2.5")"));
    EXPECT_EQ(traffic.trips[0].depart_lane, Trip::DepartLane::random);
    EXPECT_FLOAT_EQ(traffic.trips[0].speed_mps, 2.5F);
    EXPECT_TRUE(traffic.notes.empty());
    const SumoTraffic partly = read_file(written_by("Eclipse SUMO sumo 1.28.0", R"(departLane="0")"));
    EXPECT_EQ(partly.trips[0].depart_lane, Trip::DepartLane::given);
    EXPECT_EQ(partly.trips[0].depart_speed, Trip::DepartSpeed::mean);
    EXPECT_EQ(partly.notes.size(), 1U);
}

// od2trips writes the zones of a trip beside its edges.
TEST(SumoRoutes, AcceptsZonesBesideEdges) {
    const SumoTraffic traffic = read(R"(<trip id="t" depart="0" from="w_in" to="e_out" fromTaz="1" toTaz="2"/>)");
    EXPECT_EQ(traffic.trips.size(), 1U);
    EXPECT_TRUE(traffic.warnings.lines().empty());
}

TEST(SumoRoutes, FlowsCreateTheStatedNumberOfVehicles) {
    const auto count = [](const std::string& attributes) {
        return read("<flow id=\"f\" from=\"w_in\" to=\"e_out\" " + attributes + "/>").trips.size();
    };
    EXPECT_EQ(count("begin=\"10\" end=\"60\" number=\"25\""), 25U);
    EXPECT_EQ(count("begin=\"10\" end=\"60\" period=\"2\""), 25U);
    EXPECT_EQ(count("vehsPerHour=\"360\""), 10U);  // until the run ends
    EXPECT_EQ(count("begin=\"50\" end=\"500\" perHour=\"720\""), 10U);
    EXPECT_NEAR(static_cast<double>(count("probability=\"0.5\"")), 50.0, 20.0);
    EXPECT_NEAR(static_cast<double>(count("period=\"exp(0.5)\"")), 50.0, 25.0);
    const SumoTraffic flow = read("<flow id=\"f\" from=\"w_in\" to=\"e_out\" begin=\"10\" end=\"60\" number=\"5\"/>");
    EXPECT_DOUBLE_EQ(flow.trips[2].depart_s, 30.0);
    EXPECT_EQ(flow.ids[2], "f.2");
}

TEST(SumoRoutes, DrawsFromDistributions) {
    const SumoTraffic traffic = read(R"(<vTypeDistribution id="mix">
<vType id="short" length="4" probability="0.75"/><vType id="long" length="10" probability="0.25"/></vTypeDistribution>
<routeDistribution id="both"><route id="a" edges="w_in e_out" probability="0.2"/><route edges="w_in n_out" probability="0.8"/></routeDistribution>
<flow id="f" type="mix" route="both" begin="0" end="100" number="400"/>)");
    ASSERT_EQ(traffic.trips.size(), 400U);
    int longer = 0;
    int left = 0;
    for (const Trip& trip : traffic.trips) {
        longer += trip.length_m > 9.0F ? 1 : 0;
        left += traffic.turns[static_cast<std::size_t>(trip.first_turn)] == Turn::left ? 1 : 0;
    }
    EXPECT_NEAR(longer, 100, 30);
    EXPECT_NEAR(left, 320, 30);
}

TEST(SumoRoutes, TypesMayComeFromAdditionalFiles) {
    const SumoTraffic traffic =
        read(R"(<trip id="t" depart="0" type="van" from="w_in" to="e_out"/>)",
             R"(<additional><poi id="p" x="1" y="2"/><vType id="van" length="6.2"/></additional>)");
    EXPECT_FLOAT_EQ(traffic.trips[0].length_m, 6.2F);
    EXPECT_TRUE(traffic.warnings.lines().empty());
}

TEST(SumoRoutes, WarnsAboutIgnoredTypeAttributes) {
    const std::string known_attributes = R"( id="t" length="5" vClass="taxi" color="1,0,0" guiShape="taxi")";
    for (const std::string name : {"width", "laneChangeModel", "lcKeepRight", "jmTimegapMinor", "impatience",
                                   "startupDelay", "actionStepLength"}) {
        const SumoTraffic traffic = read("<vType" + known_attributes + " " + name + R"(="1"/>
<trip id="a" depart="0" from="w_in" to="e_out"/>)");
        const std::vector<std::string> lines = traffic.warnings.lines();
        ASSERT_EQ(lines.size(), 1U) << name;
        EXPECT_EQ(without_folder(lines[0]),
                  "my.rou.xml:2: '" + name +
                      "' is ignored: the scenario's populations and drivers define the driving behaviour");
    }
    const SumoTraffic nested = read("<vType" + known_attributes + R"(><carFollowing-IDM tau="1"/></vType>
<trip id="a" depart="0" from="w_in" to="e_out"/>)");
    ASSERT_EQ(nested.warnings.lines().size(), 1U);
    EXPECT_EQ(without_folder(nested.warnings.lines()[0]), "my.rou.xml:2: the element 'carFollowing-IDM' is ignored");
}

TEST(SumoRoutes, WarnsAboutIgnoredVehiclesAndStops) {
    const SumoTraffic traffic = read(R"(<vType id="b" vClass="bicycle"/>
<trip id="t" type="b" depart="0" from="w_in" to="e_out"/>
<person id="p" depart="0"/>
<trip id="car" depart="0" from="w_in" to="e_out"><stop lane="w_in_0" duration="9"/></trip>)");
    EXPECT_EQ(traffic.trips.size(), 1U);
    const std::vector<std::string> lines = traffic.warnings.lines();
    ASSERT_EQ(lines.size(), 3U);
    EXPECT_EQ(without_folder(lines[0]),
              "my.rou.xml:3: the vehicle is ignored: vehicles of its class do not use car lanes");
    EXPECT_EQ(without_folder(lines[1]), "my.rou.xml:4: the element 'person' is ignored");
    EXPECT_EQ(without_folder(lines[2]), "my.rou.xml:5: 'stop' is ignored: vehicles make no stops");
}

TEST(SumoRoutes, MalformedFilesAreRefusedWithTheirLine) {
    const SumoFiles files;
    const SumoNetwork network = make_sumo_network(read_sumo_net(files.write("my.net.xml", crossing_net())), 2.0);
    const auto message_of = [&](const std::string& text, bool additional) {
        const std::filesystem::path file = files.write("my.xml", text);
        const SumoRouteFiles names = additional ? SumoRouteFiles{{file}, {}} : SumoRouteFiles{{}, {file}};
        return refusal([&] { read_sumo_routes(names, network, kUntil_s, 1); });
    };
    for (const bool additional : {false, true}) {
        EXPECT_EQ(message_of("", additional), "my.xml:1: the file is empty");
        EXPECT_EQ(message_of("\n<!DOCTYPE routes>\n<routes/>", additional).find("my.xml:2: the file has a DOCTYPE"),
                  0U);
        EXPECT_EQ(message_of("\x1f\x8b\x08 cut", additional),
                  "my.xml:1: the gzip data are damaged or end too early here");
        EXPECT_EQ(message_of("<routes>\n<trip id='a' id='b'/>\n</routes>", additional).find("my.xml:2: "), 0U);
    }
}

struct InvalidBody {
    const char* body;
    const char* expected_text;
};
class SumoRouteErrors : public ::testing::TestWithParam<InvalidBody> {};

TEST_P(SumoRouteErrors, NameFileAndLine) {
    const std::string message = refusal([] { read(GetParam().body); });
    EXPECT_EQ(message.find("my.rou.xml:2: "), 0U) << message;
    EXPECT_NE(message.find(GetParam().expected_text), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    All, SumoRouteErrors,
    ::testing::Values(
        InvalidBody{R"(<trip id="a" depart="0" from="nowhere" to="e_out"/>)",
                    "from: there is no edge 'nowhere'; known: "},
        InvalidBody{R"(<trip id="a" depart="0" from="w_inn" to="e_out"/>)",
                    "from: there is no edge 'w_inn'; did you mean 'w_in'? Known: "},
        InvalidBody{R"(<vType id="truck"/><vehicle id="a" depart="0" type="trukc"><route edges="w_in"/></vehicle>)",
                    "there is no vType 'trukc'; did you mean 'truck'? Known: DEFAULT_BIKETYPE, "},
        InvalidBody{R"(<route id="main" edges="w_in"/><vehicle id="a" depart="0" route="mian"/>)",
                    "there is no route 'mian'; did you mean 'main'? Known: main"},
        InvalidBody{R"(<flow id="a" begin="0" end="9" vehsPerhour="600" from="w_in" to="e_out"/>)",
                    "or 'probability'; did you mean 'vehsPerHour' instead of 'vehsPerhour'?"},
        InvalidBody{R"(<trip id="a" depart="0" departSpeed="fast" from="w_in" to="e_out"/>)",
                    "element 'trip': departSpeed=\"fast\" is neither a number nor a known word; did you mean 'last'? "
                    "Known: avg, desired, last, max, random, speedLimit"},
        InvalidBody{R"(<trip id="a" depart="0" departLane="frist" from="w_in" to="e_out"/>)",
                    "did you mean 'first'? Known: "},
        InvalidBody{R"(<trip id="a" depart="0" departPos="bass" from="w_in" to="e_out"/>)",
                    "did you mean 'base'? Known: "},
        InvalidBody{R"(<trip id="a" depart="0" from="e_out" to="w_in"/>)",
                    "there is no route for cars from edge 'e_out'"},
        InvalidBody{R"(<trip id="a" depart="-1" from="w_in" to="e_out"/>)", "depart=\"-1\""},
        InvalidBody{R"(<trip id="a" depart="nan" from="w_in" to="e_out"/>)", "depart=\"nan\""},
        InvalidBody{R"(<trip id="a" from="w_in" to="e_out"/>)", "element 'trip' has no attribute 'depart'"},
        InvalidBody{R"(<vehicle id="a" depart="0"><route edges="w_in s_in"/></vehicle>)",
                    "edge 'w_in' does not lead to edge 's_in'"},
        InvalidBody{R"(<vehicle id="a" depart="0"><route edges="w_in w_in"/></vehicle>)",
                    "edge 'w_in' does not lead to edge 'w_in'"},
        InvalidBody{R"(<vehicle id="a" depart="0"><route edges=" "/></vehicle>)", "'edges' is empty"},
        InvalidBody{R"(<vehicle id="a" depart="0" route="r"/>)", "there is no route 'r'"},
        InvalidBody{R"(<vehicle id="a" depart="0" type="t"><route edges="w_in"/></vehicle>)", "there is no vType 't'"},
        InvalidBody{R"(<trip id="a" depart="0" from="w_in" to="e_out" departLane="2"/>)", "edge 'w_in' has no lane 2"},
        InvalidBody{R"(<trip id="a" depart="0" from="w_in" to="e_out" departPos="191"/>)",
                    "departPos=\"191\" must lie on edge 'w_in', which is 190.00 m long"},
        InvalidBody{R"(<trip id="a" depart="0" from="w_in" to="e_out" departPos="-191"/>)", "must lie on edge 'w_in'"},
        InvalidBody{R"(<trip id="a" depart="0" from="w_in" to="e_out" departPos="nan"/>)", "departPos"},
        InvalidBody{R"(<trip id="a" depart="0" from="w_in" to="e_out" departPos="middle"/>)", "departPos"},
        InvalidBody{
            R"(<trip id="a" depart="0" from="w_in" to="e_out"/><trip id="a" depart="0" from="w_in" to="e_out"/>)",
            "there are two vehicles 'a'"},
        InvalidBody{R"(<vType id="t" length="-3"/>)", "length=\"-3\" must be"},
        InvalidBody{R"(<vType id="t" length="inf"/>)", "not a finite number"},
        InvalidBody{R"(<vType id="t"/><vType id="t"/>)", "there are two types 't'"},
        InvalidBody{R"(<vTypeDistribution id="t" vTypes="t"/>)", "there is no vType 't'"},
        InvalidBody{R"(<routeDistribution id="r" routes="r"/>)", "there is no route 'r' before this"},
        InvalidBody{R"(<route id="r" edges="w_in"/><route id="r" edges="w_in"/>)", "there are two routes 'r'"},
        InvalidBody{R"(<route id="r" edges="w_in" repeat="3"/>)", "'repeat' is not supported"},
        InvalidBody{R"(<flow id="f" from="w_in" to="e_out" begin="0"/>)", "a flow needs 'number'"},
        InvalidBody{R"(<flow id="f" from="w_in" to="e_out" begin="9" end="3" number="2"/>)",
                    "the flow ends before it begins"},
        InvalidBody{R"(<flow id="f" from="w_in" to="e_out" period="0"/>)", "headway of the flow must be at least"},
        InvalidBody{R"(<flow id="f" from="w_in" to="e_out" vehsPerHour="-5"/>)",
                    "vehsPerHour=\"-5\" must be more than 0"},
        InvalidBody{R"(<flow id="f" from="w_in" to="e_out" perHour="0"/>)", "perHour=\"0\" must be more than 0"},
        InvalidBody{R"(<flow id="f" fromTaz="1" toTaz="2" period="1"/>)", "'fromTaz' is not supported"},
        InvalidBody{R"(<trip id="t" depart="0" from="w_in" toTaz="2"/>)", "'toTaz' is not supported without an edge"},
        InvalidBody{R"(<trip id="t" depart="0" fromJunction="J" to="e_out"/>)", "'fromJunction' is not supported"},
        InvalidBody{R"(<trip id="a" depart="0" depart="1" from="w_in" to="e_out"/>)",
                    "attribute 'depart' is given twice"},
        InvalidBody{R"(<trip id="a&b;" depart="0" from="w_in" to="e_out"/>)",
                    "element 'trip': '&b' is not an XML entity"},
        InvalidBody{R"(<!DOCTYPE routes>)", "not well-formed"},
        InvalidBody{R"(<include href="more.xml"/>)", "'include' is not supported"}));

}  // namespace
}  // namespace stopline

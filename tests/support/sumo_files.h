// Small hand-written SUMO networks for tests, and a temporary folder for their files.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include "base/input_error.h"

namespace stopline::testing {

class SumoFiles {
public:
    SumoFiles() {
        static int count = 0;
        folder_ = std::filesystem::temp_directory_path() /
                  ("stopline_sumo_" + std::to_string(getpid()) + "_" + std::to_string(count++));
        std::filesystem::create_directories(folder_);
    }
    ~SumoFiles() { std::filesystem::remove_all(folder_); }
    SumoFiles(const SumoFiles&) = delete;
    SumoFiles& operator=(const SumoFiles&) = delete;

    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }
    const std::filesystem::path& folder() const { return folder_; }

private:
    std::filesystem::path folder_;
};

// Returns dead-end junctions. Each character of `ids` is one id.
inline std::string dead_ends(const std::string& ids) {
    std::string text;
    for (const char id : ids) text += std::string("<junction id=\"") + id + "\" type=\"dead_end\" x=\"0\" y=\"0\"/>\n";
    return text;
}

// Returns `text` with the first occurrence of `from` replaced by `to`. Fails the test if `from` does not occur.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// Returns the message without the path of the temporary folder of SumoFiles.
inline std::string without_folder(const std::string& message) {
    const std::string folder = (std::filesystem::temp_directory_path() / "stopline_sumo_").string();
    return message.starts_with(folder) ? message.substr(message.find('/', folder.size()) + 1) : message;
}

// Returns the message of the InputError that an action throws, without the temporary folder.
template <class Act>
std::string refusal(const Act& action) {
    try {
        action();
    } catch (const InputError& error) {
        return without_folder(error.what());
    }
    return "(nothing was refused)";
}

// Returns two crossing streets of 200 m: w_in (two lanes) leads to e_out, s_in to n_out. The left lane of w_in also
// allows a left turn to n_out, over an internal junction. Link indices: 0: s_in, straight on; 1: right lane of w_in,
// straight on; 2: left lane of w_in, straight on; 3: left lane of w_in, left turn. Traffic on w_in has priority.
inline std::string crossing_net() {
    return R"(<?xml version="1.0" encoding="UTF-8"?>
<net version="1.20">
    <location netOffset="0.00,0.00" convBoundary="-200,-200,200,200" origBoundary="0,0,0,0" projParameter="!"/>
    <edge id=":J_0" function="internal">
        <lane id=":J_0_0" index="0" speed="13.89" length="20.00" shape="1.60,-10.00 1.60,10.00"/>
    </edge>
    <edge id=":J_1" function="internal">
        <lane id=":J_1_0" index="0" speed="13.89" length="20.00" shape="-10.00,-4.80 10.00,-4.80"/>
        <lane id=":J_1_1" index="1" speed="13.89" length="20.00" shape="-10.00,-1.60 10.00,-1.60"/>
    </edge>
    <edge id=":J_3" function="internal">
        <lane id=":J_3_0" index="0" speed="7.00" length="8.00" shape="-10.00,-1.60 -4.00,-0.60 -2.00,0.00"/>
    </edge>
    <edge id=":J_4" function="internal">
        <lane id=":J_4_0" index="0" speed="7.00" length="10.80" shape="-2.00,0.00 0.80,4.00 1.60,10.00"/>
    </edge>
    <edge id="w_in" from="W" to="J" priority="2">
        <lane id="w_in_0" index="0" speed="13.89" length="190.00" shape="-200.00,-4.80 -10.00,-4.80"/>
        <lane id="w_in_1" index="1" speed="13.89" length="190.00" shape="-200.00,-1.60 -10.00,-1.60"/>
    </edge>
    <edge id="e_out" from="J" to="E" priority="2">
        <lane id="e_out_0" index="0" speed="13.89" length="190.00" shape="10.00,-4.80 200.00,-4.80"/>
        <lane id="e_out_1" index="1" speed="13.89" length="190.00" shape="10.00,-1.60 200.00,-1.60"/>
    </edge>
    <edge id="s_in" from="S" to="J" priority="1">
        <lane id="s_in_0" index="0" speed="13.89" length="190.00" shape="1.60,-200.00 1.60,-10.00"/>
    </edge>
    <edge id="n_out" from="J" to="N" priority="1">
        <lane id="n_out_0" index="0" allow="pedestrian bicycle" speed="5.00" length="190.00" shape="3.60,10.00 3.60,200.00"/>
        <lane id="n_out_1" index="1" disallow="tram" speed="13.89" length="190.00" shape="1.60,10.00 1.60,200.00"/>
    </edge>
    <junction id="J" type="priority" x="0.00" y="0.00" incLanes="s_in_0 w_in_0 w_in_1" intLanes=":J_0_0 :J_1_0 :J_1_1 :J_4_0" shape="-10,-10 10,10">
        <request index="0" response="1110" foes="1110" cont="0"/>
        <request index="1" response="0000" foes="0001" cont="0"/>
        <request index="2" response="0000" foes="0001" cont="0"/>
        <request index="3" response="0000" foes="0001" cont="1"/>
    </junction>
    <junction id=":J_4_0" type="internal" x="-2" y="0" incLanes=":J_3_0 s_in_0" intLanes=":J_0_0"/>
    <junction id="W" type="dead_end" x="-200" y="0" incLanes="" intLanes=""/>
    <junction id="E" type="dead_end" x="200" y="0" incLanes="e_out_0 e_out_1" intLanes=""/>
    <junction id="S" type="dead_end" x="0" y="-200" incLanes="" intLanes=""/>
    <junction id="N" type="dead_end" x="0" y="200" incLanes="n_out_0 n_out_1" intLanes=""/>
    <connection from="s_in" to="n_out" fromLane="0" toLane="1" via=":J_0_0" dir="s" state="m"/>
    <connection from="w_in" to="e_out" fromLane="0" toLane="0" via=":J_1_0" dir="s" state="M"/>
    <connection from="w_in" to="e_out" fromLane="1" toLane="1" via=":J_1_1" dir="s" state="M"/>
    <connection from="w_in" to="n_out" fromLane="1" toLane="1" via=":J_3_0" dir="l" state="M"/>
    <connection from=":J_0" to="n_out" fromLane="0" toLane="1" dir="s" state="M"/>
    <connection from=":J_1" to="e_out" fromLane="0" toLane="0" dir="s" state="M"/>
    <connection from=":J_1" to="e_out" fromLane="1" toLane="1" dir="s" state="M"/>
    <connection from=":J_3" to="n_out" fromLane="0" toLane="1" via=":J_4_0" dir="l" state="M"/>
    <connection from=":J_4" to="n_out" fromLane="0" toLane="1" dir="l" state="M"/>
</net>
)";
}

// Returns edges a and b (100 m) that merge into s (`short_m` long), which leads to c (100 m). Traffic from a yields to
// traffic from b.
inline std::string merge_net(const std::string& short_m) {
    const auto edge = [](const std::string& id, const std::string& length_m, const std::string& shape) {
        const std::string internal = id[0] == ':' ? " function=\"internal\"" : " from=\"A\" to=\"B\"";
        return "<edge id=\"" + id + "\"" + internal + "><lane id=\"" + id +
               "_0\" index=\"0\" speed=\"13.89\" length=\"" + length_m + "\" shape=\"" + shape + "\"/></edge>\n";
    };
    const auto connection = [](const std::string& from, const std::string& to, const std::string& via) {
        return "<connection from=\"" + from + "\" to=\"" + to + "\" fromLane=\"0\" toLane=\"0\"" +
               (via.empty() ? "" : " via=\"" + via + "_0\"") + " dir=\"s\" state=\"M\"/>\n";
    };
    return "<net version=\"1.20\">\n" + edge(":J_0", "10", "0,10 10,0") + edge(":J_1", "10", "0,-10 10,0") +
           edge(":K_0", "5", "11,0 16,0") + edge("a", "100", "-100,10 0,10") + edge("b", "100", "-100,-10 0,-10") +
           edge("s", short_m, "10,0 11,0") + edge("c", "100", "16,0 116,0") +
           R"(<junction id="J" type="priority" x="5" y="0" incLanes="a_0 b_0" intLanes=":J_0_0 :J_1_0" shape="0,0 1,1">
<request index="0" response="10" foes="10" cont="0"/><request index="1" response="00" foes="01" cont="0"/></junction>
<junction id="K" type="priority" x="13" y="0" incLanes="s_0" intLanes=":K_0_0" shape="0,0 1,1">
<request index="0" response="0" foes="0" cont="0"/></junction>
)" + connection("a", "s", ":J_0") +
           connection("b", "s", ":J_1") + connection("s", "c", ":K_0") + connection(":J_0", "s", "") +
           connection(":J_1", "s", "") + connection(":K_0", "c", "") + dead_ends("AB") + "</net>\n";
}

// Returns part of a roundabout. Traffic from b (100 m) goes over s (2 m) to c, or exits to x before s. Traffic from a
// joins at the start of c and yields to traffic from s.
inline std::string roundabout_net() {
    return R"(<net version="1.20">
<edge id=":J_0" function="internal"><lane id=":J_0_0" index="0" speed="8" length="4" shape="0,0 4,0"/></edge>
<edge id=":J_1" function="internal"><lane id=":J_1_0" index="0" speed="8" length="6" shape="0,0 3,-5"/></edge>
<edge id=":K_0" function="internal"><lane id=":K_0_0" index="0" speed="8" length="8" shape="10,-8 14,0"/></edge>
<edge id=":K_1" function="internal"><lane id=":K_1_0" index="0" speed="8" length="8" shape="6,0 14,0"/></edge>
<edge id="a" from="A" to="K"><lane id="a_0" index="0" speed="13.89" length="100" shape="10,-108 10,-8"/></edge>
<edge id="b" from="B" to="J"><lane id="b_0" index="0" speed="8" length="100" shape="-100,0 0,0"/></edge>
<edge id="s" from="J" to="K"><lane id="s_0" index="0" speed="8" length="2" shape="4,0 6,0"/></edge>
<edge id="c" from="K" to="C"><lane id="c_0" index="0" speed="13.89" length="100" shape="14,0 114,0"/></edge>
<edge id="x" from="J" to="X"><lane id="x_0" index="0" speed="13.89" length="100" shape="3,-5 3,-105"/></edge>
<junction id="J" type="priority" x="2" y="0" incLanes="b_0" intLanes=":J_0_0 :J_1_0" shape="0,0 1,1">
<request index="0" response="00" foes="00" cont="0"/><request index="1" response="00" foes="00" cont="0"/></junction>
<junction id="K" type="priority" x="10" y="0" incLanes="a_0 s_0" intLanes=":K_0_0 :K_1_0" shape="0,0 1,1">
<request index="0" response="10" foes="10" cont="0"/><request index="1" response="00" foes="01" cont="0"/></junction>
<connection from="b" to="s" fromLane="0" toLane="0" via=":J_0_0" dir="s" state="M"/>
<connection from="b" to="x" fromLane="0" toLane="0" via=":J_1_0" dir="r" state="M"/>
<connection from="a" to="c" fromLane="0" toLane="0" via=":K_0_0" dir="r" state="m"/>
<connection from="s" to="c" fromLane="0" toLane="0" via=":K_1_0" dir="s" state="M"/>
<connection from=":J_0" to="s" fromLane="0" toLane="0" dir="s" state="M"/>
<connection from=":J_1" to="x" fromLane="0" toLane="0" dir="r" state="M"/>
<connection from=":K_0" to="c" fromLane="0" toLane="0" dir="r" state="M"/>
<connection from=":K_1" to="c" fromLane="0" toLane="0" dir="s" state="M"/>
)" + dead_ends("ABCX") +
           "</net>\n";
}

// Returns edge a (100 m) with connections straight to c, right to d, and a tight U-turn to b as netconvert draws it.
inline std::string turnaround_net() {
    return R"(<net version="1.20">
<edge id=":J_0" function="internal"><lane id=":J_0_0" index="0" speed="9" length="9.2" shape="0,-1.6 3,-2.2 5.2,-4.6 6,-8"/></edge>
<edge id=":J_1" function="internal"><lane id=":J_1_0" index="0" speed="13.89" length="14" shape="0,-1.6 14,-1.6"/></edge>
<edge id=":J_2" function="internal"><lane id=":J_2_0" index="0" speed="4" length="4.5" shape="0,-1.6 1.2,-0.8 1.2,0.8 0,1.6"/></edge>
<edge id="a" from="A" to="J"><lane id="a_0" index="0" speed="13.89" length="100" shape="-100,-1.6 0,-1.6"/></edge>
<edge id="b" from="J" to="A"><lane id="b_0" index="0" speed="13.89" length="100" shape="0,1.6 -100,1.6"/></edge>
<edge id="c" from="J" to="C"><lane id="c_0" index="0" speed="13.89" length="100" shape="14,-1.6 114,-1.6"/></edge>
<edge id="d" from="J" to="D"><lane id="d_0" index="0" speed="13.89" length="100" shape="6,-8 6,-108"/></edge>
<junction id="J" type="priority" x="7" y="0" incLanes="a_0" intLanes=":J_0_0 :J_1_0 :J_2_0" shape="0,0 1,1">
<request index="0" response="000" foes="000" cont="0"/><request index="1" response="000" foes="000" cont="0"/>
<request index="2" response="000" foes="000" cont="0"/></junction>
<connection from="a" to="d" fromLane="0" toLane="0" via=":J_0_0" dir="r" state="M"/>
<connection from="a" to="c" fromLane="0" toLane="0" via=":J_1_0" dir="s" state="M"/>
<connection from="a" to="b" fromLane="0" toLane="0" via=":J_2_0" dir="t" state="M"/>
<connection from=":J_0" to="d" fromLane="0" toLane="0" dir="r" state="M"/>
<connection from=":J_1" to="c" fromLane="0" toLane="0" dir="s" state="M"/>
<connection from=":J_2" to="b" fromLane="0" toLane="0" dir="t" state="M"/>
)" + dead_ends("ACD") +
           "</net>\n";
}

// Returns an edge a (100 m, one lane) that leads to d (right turn), c (straight on) and b (a slight left turn).
// Vehicles to d diverge from the others after a few metres. Vehicles to b and to c diverge from each other after more
// than 30 m.
inline std::string fork_net() {
    return R"(<net version="1.20">
<edge id=":J_0" function="internal"><lane id=":J_0_0" index="0" speed="9" length="9.2" shape="0,-1.6 3,-2.2 5.2,-4.6 6,-8"/></edge>
<edge id=":J_1" function="internal"><lane id=":J_1_0" index="0" speed="13.89" length="40" shape="0,-1.6 40,-1.6"/></edge>
<edge id=":J_2" function="internal"><lane id=":J_2_0" index="0" speed="13.89" length="40.26" shape="0,-1.6 20,-1.2 40,2"/></edge>
<edge id="a" from="A" to="J"><lane id="a_0" index="0" speed="13.89" length="100" shape="-100,-1.6 0,-1.6"/></edge>
<edge id="b" from="J" to="B"><lane id="b_0" index="0" speed="13.89" length="100" shape="40,2 138.7,18"/></edge>
<edge id="c" from="J" to="C"><lane id="c_0" index="0" speed="13.89" length="100" shape="40,-1.6 140,-1.6"/></edge>
<edge id="d" from="J" to="D"><lane id="d_0" index="0" speed="13.89" length="100" shape="6,-8 6,-108"/></edge>
<junction id="J" type="priority" x="7" y="0" incLanes="a_0" intLanes=":J_0_0 :J_1_0 :J_2_0" shape="0,0 1,1">
<request index="0" response="000" foes="000" cont="0"/><request index="1" response="000" foes="000" cont="0"/>
<request index="2" response="000" foes="000" cont="0"/></junction>
<connection from="a" to="d" fromLane="0" toLane="0" via=":J_0_0" dir="r" state="M"/>
<connection from="a" to="c" fromLane="0" toLane="0" via=":J_1_0" dir="s" state="M"/>
<connection from="a" to="b" fromLane="0" toLane="0" via=":J_2_0" dir="l" state="M"/>
<connection from=":J_0" to="d" fromLane="0" toLane="0" dir="r" state="M"/>
<connection from=":J_1" to="c" fromLane="0" toLane="0" dir="s" state="M"/>
<connection from=":J_2" to="b" fromLane="0" toLane="0" dir="l" state="M"/>
)" + dead_ends("ABCD") +
           "</net>\n";
}

// Returns an edge with two lanes (100 m) that merge into the single lane of a short edge, and an edge beyond it.
inline std::string lane_drop_net() {
    return R"(<net version="1.20">
<edge id=":J_0" function="internal"><lane id=":J_0_0" index="0" speed="13.89" length="4" shape="0,0 4,0"/></edge>
<edge id=":J_1" function="internal"><lane id=":J_1_0" index="0" speed="13.89" length="4" shape="0,3.2 4,0"/></edge>
<edge id=":K_0" function="internal"><lane id=":K_0_0" index="0" speed="13.89" length="8" shape="9,0 17,0"/></edge>
<edge id="a" from="A" to="J">
<lane id="a_0" index="0" speed="13.89" length="100" shape="-100,0 0,0"/>
<lane id="a_1" index="1" speed="13.89" length="100" shape="-100,3.2 0,3.2"/></edge>
<edge id="s" from="J" to="K"><lane id="s_0" index="0" speed="13.89" length="5" shape="4,0 9,0"/></edge>
<edge id="c" from="K" to="C"><lane id="c_0" index="0" speed="13.89" length="100" shape="17,0 117,0"/></edge>
<junction id="J" type="priority" x="2" y="0" incLanes="a_0 a_1" intLanes=":J_0_0 :J_1_0" shape="0,0 1,1">
<request index="0" response="00" foes="10" cont="0"/><request index="1" response="01" foes="01" cont="0"/></junction>
<junction id="K" type="priority" x="13" y="0" incLanes="s_0" intLanes=":K_0_0" shape="0,0 1,1">
<request index="0" response="0" foes="0" cont="0"/></junction>
<connection from="a" to="s" fromLane="0" toLane="0" via=":J_0_0" dir="s" state="M"/>
<connection from="a" to="s" fromLane="1" toLane="0" via=":J_1_0" dir="s" state="m"/>
<connection from="s" to="c" fromLane="0" toLane="0" via=":K_0_0" dir="s" state="M"/>
<connection from=":J_0" to="s" fromLane="0" toLane="0" dir="s" state="M"/>
<connection from=":J_1" to="s" fromLane="0" toLane="0" dir="s" state="M"/>
<connection from=":K_0" to="c" fromLane="0" toLane="0" dir="s" state="M"/>
)" + dead_ends("AC") +
           "</net>\n";
}

// Returns a street with one lane in each direction. Left-turning vehicles wait inside the junction until oncoming
// traffic has passed.
inline std::string opposing_lefts_net() {
    return R"(<net version="1.20">
<edge id=":J_0" function="internal"><lane id=":J_0_0" index="0" speed="13.89" length="24" shape="-12,-3.2 12,-3.2"/></edge>
<edge id=":J_1" function="internal"><lane id=":J_1_0" index="0" speed="7" length="23" shape="-12,-3.2 -7,-2.2 -4,-0.6 -1,2 3.2,7 3.2,12"/></edge>
<edge id=":J_2" function="internal"><lane id=":J_2_0" index="0" speed="13.89" length="24" shape="12,3.2 -12,3.2"/></edge>
<edge id=":J_3" function="internal"><lane id=":J_3_0" index="0" speed="7" length="23" shape="12,3.2 7,2.2 4,0.6 1,-2 -3.2,-7 -3.2,-12"/></edge>
<edge id="w" from="W" to="J"><lane id="w_0" index="0" speed="13.89" length="100" shape="-112,-3.2 -12,-3.2"/></edge>
<edge id="e" from="E" to="J"><lane id="e_0" index="0" speed="13.89" length="100" shape="112,3.2 12,3.2"/></edge>
<edge id="to_e" from="J" to="E"><lane id="to_e_0" index="0" speed="13.89" length="100" shape="12,-3.2 112,-3.2"/></edge>
<edge id="to_w" from="J" to="W"><lane id="to_w_0" index="0" speed="13.89" length="100" shape="-12,3.2 -112,3.2"/></edge>
<edge id="to_n" from="J" to="N"><lane id="to_n_0" index="0" speed="13.89" length="100" shape="3.2,12 3.2,112"/></edge>
<edge id="to_s" from="J" to="S"><lane id="to_s_0" index="0" speed="13.89" length="100" shape="-3.2,-12 -3.2,-112"/></edge>
<junction id="J" type="priority" x="0" y="0" incLanes="w_0 e_0" intLanes=":J_0_0 :J_1_0 :J_2_0 :J_3_0" shape="0,0 1,1">
<request index="0" response="0000" foes="1000" cont="0"/><request index="1" response="0100" foes="0100" cont="1"/>
<request index="2" response="0000" foes="0010" cont="0"/><request index="3" response="0001" foes="0001" cont="1"/></junction>
<connection from="w" to="to_e" fromLane="0" toLane="0" via=":J_0_0" dir="s" state="M"/>
<connection from="w" to="to_n" fromLane="0" toLane="0" via=":J_1_0" dir="l" state="m"/>
<connection from="e" to="to_w" fromLane="0" toLane="0" via=":J_2_0" dir="s" state="M"/>
<connection from="e" to="to_s" fromLane="0" toLane="0" via=":J_3_0" dir="l" state="m"/>
<connection from=":J_0" to="to_e" fromLane="0" toLane="0" dir="s" state="M"/>
<connection from=":J_1" to="to_n" fromLane="0" toLane="0" dir="l" state="M"/>
<connection from=":J_2" to="to_w" fromLane="0" toLane="0" dir="s" state="M"/>
<connection from=":J_3" to="to_s" fromLane="0" toLane="0" dir="l" state="M"/>
)" + dead_ends("WENS") +
           "</net>\n";
}

// Returns crossing_net() with signals. Each phase has one letter for each of the links 0 to 3.
inline std::string signal_net(const std::string& phases) {
    std::string text = crossing_net();
    text = replaced(text, "    <junction id=\"J\" type=\"priority\"",
                    "    <tlLogic id=\"J\" type=\"static\" programID=\"0\" offset=\"0\">\n" + phases +
                        "    </tlLogic>\n    <junction id=\"J\" type=\"traffic_light\"");
    text = replaced(text, "via=\":J_0_0\" dir", "via=\":J_0_0\" tl=\"J\" linkIndex=\"0\" dir");
    text = replaced(text, "via=\":J_1_0\" dir", "via=\":J_1_0\" tl=\"J\" linkIndex=\"1\" dir");
    text = replaced(text, "via=\":J_1_1\" dir", "via=\":J_1_1\" tl=\"J\" linkIndex=\"2\" dir");
    return replaced(text, "via=\":J_3_0\" dir", "via=\":J_3_0\" tl=\"J\" linkIndex=\"3\" dir");
}

inline std::string two_phases() {
    return R"(        <phase duration="20" state="rGGG"/>
        <phase duration="4" state="ryyy"/>
        <phase duration="12" state="Grrr"/>
        <phase duration="4" state="yrrr"/>
)";
}

}  // namespace stopline::testing

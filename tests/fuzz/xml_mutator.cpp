#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/mutators.h"
#include "fuzz/packing.h"

namespace stopline::fuzz {

namespace {

// A byte range of the text.
struct Range {
    std::size_t begin = 0;
    std::size_t end = 0;
    std::string_view of(std::string_view text) const { return text.substr(begin, end - begin); }
};

constexpr std::array<std::string_view, 31> kElements{
    R"(<vehicle id="n1" depart="0"><route edges="ni eo"/></vehicle>)",
    R"(<trip id="n2" depart="0.5" from="ni" to="eo"/>)",
    R"(<flow id="n3" begin="0" end="2" number="3" from="ni" to="eo"/>)",
    R"(<flow id="n4" begin="0" end="2" probability="0.5" from="ni" to="eo"/>)",
    R"xml(<flow id="n5" begin="0" end="2" period="exp(1)" from="ni" to="eo"/>)xml",
    R"(<vType id="t1" vClass="passenger" length="5" accel="2" decel="4" tau="1" minGap="2" sigma="0.5"/>)",
    R"(<vTypeDistribution id="t2" vTypes="t1" probabilities="1"/>)",
    R"(<route id="r1" edges="ni eo"/>)",
    R"(<routeDistribution id="r2"><route edges="ni eo" probability="1"/></routeDistribution>)",
    R"(<inductionLoop id="l1" lane="ni_0" pos="-5" file="x"/>)",
    R"(<tlLogic id="c" programID="1" type="static" offset="0"><phase duration="30" state="GGgrrrGGgrrr"/></tlLogic>)",
    R"(<tlLogic id="c" programID="2" type="actuated" offset="0"><phase duration="30" minDur="5" maxDur="50" state="GGgrrrGGgrrr"/></tlLogic>)",
    R"(<tlLogic id="c" programID="3" type="NEMA" offset="0"><param key="ring1" value="1,2,3,4"/></tlLogic>)",
    R"(<param key="barrierPhases" value="4,8"/>)",
    R"(<phase duration="3" state="rrryyyrrryyy" next="0 1"/>)",
    R"(<edge id="n6" from="ni" to="eo"><lane id="n6_0" index="0" speed="10" length="50" shape="0,0 50,0"/></edge>)",
    R"(<edge id=":n7" function="internal"><lane id=":n7_0" index="0" speed="10" length="5" shape="0,0 5,0"/></edge>)",
    R"(<lane id="e_1" index="1" speed="10" length="50" shape="0,3 50,3"/>)",
    R"(<connection from="ni" to="eo" fromLane="0" toLane="0" via=":c_0_0" tl="c" linkIndex="0" dir="s" state="O"/>)",
    R"(<connection from="ni" to="eo" fromLane="0" toLane="0" dir="t" state="Z" pass="1" keepClear="0"/>)",
    R"(<junction id="n8" type="priority" x="0" y="0" incLanes="ni_0" intLanes=":c_0_0"/>)",
    R"(<request index="0" response="00" foes="11" cont="1"/>)",
    R"(<stop lane="ni_0" duration="5"/>)",
    R"(<include href="x.xml"/>)",
    R"(<roundabout nodes="a b" edges="c d"/>)",
    R"(<WAUT id="w"/>)",
    R"(<neigh lane="ni_0"/>)",
    R"(<!-- SUMO netconvert 1.20.0 -->)",
    R"(<![CDATA[ x ]]>)",
    R"(<?xml version="1.0"?>)",
    R"(text &amp; &#65; text)"};

constexpr std::array<std::string_view, 28> kValues{
    "",     "0",      "1",      "-1",   "2",        "1e-9",     "1e-300",  "1e300",     "1e9",  "999999999",
    "nan",  "inf",    "0.1",    "30",   "00:01:00", "a b",      "0,0 1,0", "0,0 0,0,5", "best", "max",
    "last", "exp(1)", "random", "true", "priority", "dead_end", "NEMA",    "&#27;[31m"};

// Returns the tags of the text, from '<' to '>'.
std::vector<Range> tags_of(std::string_view text) {
    std::vector<Range> tags;
    for (std::size_t k = text.find('<'); k != std::string_view::npos; k = text.find('<', k + 1)) {
        const std::size_t end = text.find('>', k);
        if (end == std::string_view::npos) break;
        tags.push_back({k, end + 1});
    }
    return tags;
}

// Returns the attributes of a tag, from the name to the closing quote.
std::vector<Range> attributes_of(std::string_view text, const Range& tag) {
    std::vector<Range> attributes;
    for (std::size_t k = text.find("=\"", tag.begin); k < tag.end; k = text.find("=\"", k + 1)) {
        const std::size_t name = text.find_last_of(" \t\n<", k);
        const std::size_t end = text.find('"', k + 2);
        if (name == std::string_view::npos || end >= tag.end) break;
        attributes.push_back({name + 1, end + 1});
        k = end;
    }
    return attributes;
}

// Replaces the value of an attribute by a value of the list, or by that of another attribute.
void replace_value(std::string& text, const std::vector<Range>& tags, const Range& attribute, Random& random) {
    std::string value(random.one_of(kValues));
    const std::vector<Range> others = attributes_of(text, random.one_of(tags));
    if (!others.empty() && random.below(2) == 0) {
        const std::string_view other = random.one_of(others).of(text);
        value = other.substr(other.find('"') + 1, other.size() - other.find('"') - 2);
    }
    const std::size_t begin = text.find('"', attribute.begin) + 1;
    text.replace(begin, attribute.end - 1 - begin, value);
}

void change_attribute(std::string& text, const std::vector<Range>& tags, const Range& tag, Random& random) {
    const std::vector<Range> attributes = attributes_of(text, tag);
    if (attributes.empty()) return;
    const Range attribute = random.one_of(attributes);
    switch (random.below(6)) {
        case 0:
            text.erase(attribute.begin, attribute.end - attribute.begin);
            return;
        case 1:
            text.insert(attribute.begin, std::string(attribute.of(text)) + " ");
            return;
        default:
            return replace_value(text, tags, attribute, random);
    }
}

void change_element(std::string& text, const std::vector<Range>& tags, const Range& tag, Random& random) {
    const Range other = random.one_of(tags);
    switch (random.below(5)) {
        case 0:
            text.erase(tag.begin, tag.end - tag.begin);
            return;
        case 1:
            text.insert(tag.end, std::string(other.of(text)));
            return;
        case 2: {  // copies all from one tag to another
            const Range both{std::min(tag.begin, other.begin), std::max(tag.end, other.end)};
            constexpr std::size_t kMaxCopy = 2000;
            if (both.end - both.begin < kMaxCopy) text.insert(random.one_of(tags).begin, std::string(both.of(text)));
            return;
        }
        default:
            text.insert(tag.end, std::string(random.one_of(kElements)));
            return;
    }
}

void change(std::string& text, Random& random, ByteMutator mutate_bytes) {
    const std::vector<Range> tags = tags_of(text);
    if (tags.empty() || random.below(8) == 0) return mutate_bytes(text);
    const Range tag = random.one_of(tags);
    if (random.below(3) == 0) return change_element(text, tags, tag, random);
    change_attribute(text, tags, tag, random);
}

}  // namespace

void mutate_xml(std::string& text, Random& random, ByteMutator mutate_bytes) {
    const bool gzipped = is_gzip(text);
    std::string unpacked = gzipped ? unpack_gzip(text) : text;
    for (std::size_t changes = 1 + random.below(3); changes > 0; --changes) change(unpacked, random, mutate_bytes);
    const bool pack = gzipped != (random.below(64) == 0);
    text = pack ? pack_gzip(unpacked) : unpacked;
}

}  // namespace stopline::fuzz

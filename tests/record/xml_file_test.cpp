// Tests of XML output for SUMO: lane names and complete files.
#include "record/xml_file.h"

#include <gtest/gtest.h>

#include "scenario/scenario_text.h"

namespace stopline {
namespace {

TEST(XmlFile, ConnectionNamesBeginWithAColon) {
    Lane lane;
    lane.name = "c0r0_west_in_1";
    EXPECT_EQ(sumo_lane_name(lane), "c0r0_west_in_1");
    lane.name = "c0r0_west_1_left";
    lane.origin = 3;
    EXPECT_EQ(sumo_lane_name(lane), ":c0r0_west_1_left_0");
}

TEST(XmlFile, AppearsWhenFinished) {
    const TemporaryFolder folder;
    {
        XmlFile xml(folder.path() / "a.xml", "root", "a.xsd");
        xml.add("<b c=\"{}\"/>\n", 1);
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    XmlFile xml(folder.path() / "a.xml", "root", "a.xsd");
    xml.add("<b c=\"{}\"/>\n", 1);
    xml.finish();
    EXPECT_TRUE(contains(read_text(folder.path() / "a.xml"), "<b c=\"1\"/>\n</root>\n"));
}

}  // namespace
}  // namespace stopline

// What any name becomes in XML.
#include "record/xml_file.h"

#include <gtest/gtest.h>

#include "scenario/scenario_text.h"

namespace stopline {
namespace {

TEST(XmlFile, EscapesWhatAnAttributeCannotHold) {
    EXPECT_EQ(xml_escaped("CTG-Ref"), "CTG-Ref");
    EXPECT_EQ(xml_escaped("a<b>&\"c\"\n\t"), "a&lt;b&gt;&amp;&quot;c&quot;&#10;&#9;");
    EXPECT_EQ(xml_escaped(std::string("nul\0bell\a", 9)), "nul?bell?");
    EXPECT_EQ(xml_escaped("Stra\xc3\x9f"
                          "e"),
              "Stra\xc3\x9f"
              "e");
}

TEST(XmlFile, NamesOfLanesInsideAnIntersectionBeginWithAColon) {
    Lane lane;
    lane.name = "c0r0_west_in_1";
    EXPECT_EQ(sumo_lane_name(lane), "c0r0_west_in_1");
    lane.name = "c0r0_west_1_left";
    lane.origin = 3;
    EXPECT_EQ(sumo_lane_name(lane), ":c0r0_west_1_left_0");
}

TEST(XmlFile, IsThereOnceItIsFinished) {
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

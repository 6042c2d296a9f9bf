// Tests of ids and tables in HTML.
#include "paper/report/html.h"

#include <gtest/gtest.h>

namespace stopline {
namespace {

TEST(HtmlId, HasOnlyValidCharacters) { EXPECT_EQ(html_id("fig26/series 5 %.x"), "fig26-series-5---x"); }

TEST(HtmlTable, LabelsCellsWithTheirColumnAndEscapesText) {
    HtmlTable table("a < b", {"Row", "Paper & ours"});
    table.row({{"L<1"}, {"17", "number"}}, "row L1");
    const std::string html = table.html();
    EXPECT_NE(html.find("<caption>a &lt; b</caption>"), std::string::npos) << html;
    EXPECT_NE(html.find("<th scope=\"col\" class=\"number\">Paper &amp; ours</th>"), std::string::npos) << html;
    EXPECT_NE(html.find("<tr id=\"row-L1\"><th scope=\"row\">L&lt;1</th>"
                        "<td class=\"number\" data-label=\"Paper &amp; ours\">17</td></tr>"),
              std::string::npos)
        << html;
}

TEST(HtmlTable, FromCsvMarksNumericCells) {
    const std::string html = html_of_csv("name,gain_percent\nCDG,52.1\n\"a,b\",\n", "x.csv");
    EXPECT_NE(html.find("<td class=\"number\" data-label=\"gain_percent\">52.1</td>"), std::string::npos) << html;
    EXPECT_NE(html.find("<th scope=\"row\">a,b</th><td data-label=\"gain_percent\"></td>"), std::string::npos) << html;
    EXPECT_EQ(html.find("<caption>"), std::string::npos);
}

}  // namespace
}  // namespace stopline

#include "base/io/escape.h"

#include <gtest/gtest.h>

#include <string>

namespace stopline {
namespace {

TEST(EscapeHtml, ReplacesMarkupAndForbiddenCharacters) {
    EXPECT_EQ(escape_html("<b class=\"x\">a & b</b>"), "&lt;b class=&quot;x&quot;&gt;a &amp; b&lt;/b&gt;");
    EXPECT_EQ(escape_html("green >= 20 s, ±1 %"), "green &gt;= 20 s, ±1 %");
    EXPECT_EQ(escape_html("one\ntwo\tthree"), "one\ntwo\tthree");
    EXPECT_EQ(escape_html(std::string("a\0b\x1f", 4)),
              "a\xEF\xBF\xBD"
              "b\xEF\xBF\xBD");
}

TEST(EscapeXml, ReplacesMarkupAndForbiddenCharacters) {
    EXPECT_EQ(escape_xml("CTG-Ref"), "CTG-Ref");
    EXPECT_EQ(escape_xml("a<b>&\"c\"\n\t"), "a&lt;b&gt;&amp;&quot;c&quot;&#10;&#9;");
    EXPECT_EQ(escape_xml(std::string("nul\0bell\a", 9)), "nul?bell?");
    EXPECT_EQ(escape_xml("Stra\xc3\x9f"
                         "e"),
              "Stra\xc3\x9f"
              "e");
}

TEST(EscapeMarkdownCell, ReplacesMarkupAndLineBreaks) {
    EXPECT_EQ(escape_markdown_cell("a|b *c*\n<A11> no_turns"), "a\\|b \\*c\\* \\<A11> no_turns");
}

}  // namespace
}  // namespace stopline

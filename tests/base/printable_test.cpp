#include "base/io/printable.h"

#include <gtest/gtest.h>

#include <string>

#include "base/input_error.h"

namespace stopline {
namespace {

TEST(Printable, KeepsTextAndLineBreaks) {
    for (const char* const text : {"", "CTG-Ref", "Grün € 🚦", "one\n\ttwo", "a'b\"c\\d"}) {
        EXPECT_EQ(printable_text(text), text);
        EXPECT_FALSE(has_control_characters(text)) << text;
    }
}

TEST(Printable, WritesControlCharactersAsBytes) {
    EXPECT_EQ(printable_text("a\x1b[31mb"), "a\\x1B[31mb");
    EXPECT_EQ(printable_text("a\rb\bc\x7f"), "a\\x0Db\\x08c\\x7F");
    EXPECT_EQ(printable_text("\xC2\x9B"), "\\xC2\\x9B");           // C1 control sequence introducer
    EXPECT_EQ(printable_text("\xE2\x80\xAE"), "\\xE2\\x80\\xAE");  // right-to-left override
    EXPECT_EQ(printable_text("\xFF\xC3"), "\\xFF\\xC3");           // not UTF-8
    EXPECT_EQ(printable_text(std::string("\0", 1)), "\\x00");
    EXPECT_TRUE(has_control_characters("a\x1b"));
}

TEST(Printable, MessagesOfInputErrorsArePrintable) {
    EXPECT_STREQ(InputError("there is no edge '\x1b[2J'\nsecond line").what(),
                 "there is no edge '\\x1B[2J'\nsecond line");
}

}  // namespace
}  // namespace stopline

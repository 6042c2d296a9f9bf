#include "base/io/csv.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "scenario/scenario_text.h"

namespace stopline {
namespace {

TEST(Csv, ReadsBackWhatItWrites) {
    const std::vector<std::vector<std::string>> rows{
        {"plain", "a, b", "c"}, {"say \"so\"", "two\nlines", ""}, {"", "", "±1"}};
    CsvWriter writer({"x", "y", "z"});
    for (const auto& row : rows) writer.row(row);
    const CsvTable table = parse_csv(writer.text(), "t.csv");
    EXPECT_EQ(table.columns, (std::vector<std::string>{"x", "y", "z"}));
    EXPECT_EQ(table.rows, rows);
    EXPECT_EQ(table.column("z"), 2U);
}

TEST(Csv, QuotesOnlyIfNeeded) {
    CsvWriter writer({"a", "b"});
    writer.row({"1.5", "x,y"});
    EXPECT_EQ(writer.text(), "a,b\n1.5,\"x,y\"\n");
    EXPECT_THROW(writer.row({"one"}), std::logic_error);
}

TEST(Csv, ReadsLineEndsOfAllKinds) {
    const CsvTable table = parse_csv("a,b\r\n1,2\r\n\r\n3,4", "t.csv");
    EXPECT_EQ(table.rows, (std::vector<std::vector<std::string>>{{"1", "2"}, {"3", "4"}}));
}

TEST(Csv, SkipsTheByteOrderMarkOfSpreadsheets) {
    EXPECT_EQ(parse_csv("\xEF\xBB\xBF"
                        "a,b\n1,2\n",
                        "t.csv")
                  .columns,
              (std::vector<std::string>{"a", "b"}));
}

TEST(Csv, RefusesMalformedTables) {
    const auto error = [](const char* text) { return input_error_of([&] { parse_csv(text, "t.csv"); }); };
    EXPECT_TRUE(contains(error(""), "t.csv: the file is empty"));
    EXPECT_TRUE(contains(error("a,b\n1,2\n3\n"), "t.csv:3: the number of fields is 1, but the header has 2 columns"));
    EXPECT_TRUE(contains(error("a,b\n1,\"2\n3,4\n"), "t.csv:2: the quote that opens here is never closed"));
    EXPECT_TRUE(contains(error("a,b\n\"x\ny\",2\n1\n"), "t.csv:4:"));  // a line break inside quotes counts as a line
    const CsvTable table = parse_csv("a,b\n", "t.csv");
    EXPECT_TRUE(
        contains(input_error_of([&] { (void)table.column("c"); }), "there is no column 'c'; the columns are a, b"));
}

TEST(Fixed, HasNoNegativeZeroAndNoNan) {
    EXPECT_EQ(fixed(1.23456, 3), "1.235");
    EXPECT_EQ(fixed(-0.0001, 3), "0.000");
    EXPECT_EQ(fixed(-0.001, 3), "-0.001");
    EXPECT_EQ(fixed(-0.4, 0), "0");
    EXPECT_EQ(fixed(std::nan(""), 2), "");
}

}  // namespace
}  // namespace stopline

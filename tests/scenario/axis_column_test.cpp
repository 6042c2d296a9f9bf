// Tests of the texts that stand for the values of a sweep axis in result tables. Two values have equal texts only if
// they mean the same, such as 60 s and 1 min.
#include "scenario/sweep_file/axis_column.h"

#include <gtest/gtest.h>

namespace stopline {
namespace {

using Texts = std::vector<std::string>;

TEST(AxisColumn, OfOneFieldHasNumbersInTheUnitOfItsName) {
    const AxisColumn column = axis_column({"green", {"signal.green"}, {"60 s", "2 min", "0.5 s"}, {}});
    EXPECT_EQ(column.name, "green_s");
    EXPECT_EQ(column.cells, (Texts{"60", "120", "0.5"}));
    EXPECT_EQ(column.titles, (Texts{"60 s", "120 s", "0.5 s"}));
}

TEST(AxisColumn, OfSeveralFieldsUsesTheFirstIfItsValuesDiffer) {
    const AxisColumn column = axis_column({"turns", {"demand.left", "demand.right"}, {"0 %", "5 % | 10 %"}, {}});
    EXPECT_EQ(column.name, "turns_percent");
    EXPECT_EQ(column.cells, (Texts{"0", "5"}));
    EXPECT_EQ(column.titles, (Texts{"0 %", "5 % / 10 %"}));
}

TEST(AxisColumn, OfSeveralFieldsUsesAllIfValuesOfTheFirstRepeat) {
    const AxisColumn column = axis_column({"turns", {"demand.left", "demand.right"}, {"5 % | 10 %", "5 % | 30 %"}, {}});
    EXPECT_EQ(column.name, "turns");
    EXPECT_EQ(column.cells, (Texts{"5 % / 10 %", "5 % / 30 %"}));
    EXPECT_EQ(column.titles, column.cells);
}

TEST(AxisColumn, OfSectionsHasReadableTitles) {
    const SweepAxis axis{
        "traffic", {"demand"}, {"{kind: saturated, left: 5 %}", "{kind: rate, inflow: 600 veh/h}"}, {}};
    EXPECT_EQ(axis_column(axis).cells, axis.values);
    EXPECT_EQ(axis_column(axis).titles, (Texts{"saturated, left 5 %", "rate, inflow 600 veh/h"}));
}

TEST(AxisParts, AreEqualForEquivalentValues) {
    const SweepAxis axis{"a", {"signal.green", "signal.yellow"}, {"60 s | 3 s", "1 min | 3000 ms", "60 s"}, {}};
    EXPECT_EQ(axis_parts(axis, 0), axis_parts(axis, 1));
    EXPECT_NE(axis_parts(axis, 0), axis_parts(axis, 2));
}

}  // namespace
}  // namespace stopline

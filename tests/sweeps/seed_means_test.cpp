// Compares means and differences over seeds with values calculated by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "sweeps/seed_means.h"

namespace stopline {
namespace {

const char* const kTable =
    "point,green_s,population,seed,throughput_veh_h,stability,updates\n"
    "0,10,A,1,100,stable,5\n"
    "1,10,A,2,104,stable,5\n"
    "2,10,A,3,108,stable,5\n"
    "3,10,B,1,111,unstable,5\n"
    "4,10,B,2,114,unstable,5\n"
    "5,10,B,3,117,,5\n"
    "6,20,A,1,50,stable,5\n"
    "7,20,B,1,60,stable,5\n";

double number(const CsvTable& table, std::size_t row, const char* column) {
    return std::stod(table.rows[row][table.column(column)]);
}

TEST(SeedMeans, HaveStudentIntervalsAndPairedDifferences) {
    const CsvTable results = parse_csv(kTable, "table");
    ASSERT_TRUE(has_seeds(results));
    const CsvTable means = parse_csv(seed_means_csv(results, "population"), "means");
    // One row for each of the four combinations of green_s and population. Throughput is the only metric, because
    // `stability` is a text and `updates` describes the computation.
    ASSERT_EQ(means.rows.size(), 4u);
    constexpr double kT = 4.302653;  // Student's quantile for 95 %, two degrees of freedom
    EXPECT_EQ(means.rows[0][means.column("metric")], "throughput_veh_h");
    EXPECT_NEAR(number(means, 0, "mean"), 104.0, 1e-9);
    EXPECT_NEAR(number(means, 0, "ci95_high"), 104.0 + kT * 4.0 / std::sqrt(3.0), 1e-3);
    EXPECT_EQ(means.rows[0][means.column("difference")], "");
    // The differences B - A are 11, 10 and 9. Their interval is far narrower than those of A and B.
    EXPECT_NEAR(number(means, 1, "difference"), 10.0, 1e-9);
    EXPECT_NEAR(number(means, 1, "difference_ci95_low"), 10.0 - kT * 1.0 / std::sqrt(3.0), 1e-3);
    EXPECT_NEAR(number(means, 1, "difference_ci95_high"), 10.0 + kT * 1.0 / std::sqrt(3.0), 1e-3);
    EXPECT_EQ(means.rows[2][means.column("runs")], "1");
    EXPECT_EQ(means.rows[3][means.column("difference")], "") << "one pair has no interval";
}

TEST(SeedMeans, NeedSeveralSeeds) {
    EXPECT_FALSE(has_seeds(parse_csv("point,population,seed,x\n0,A,1,5\n1,B,1,6\n", "table")));
    EXPECT_FALSE(has_seeds(parse_csv("point,x\n0,5\n", "table")));
}

TEST(SeedMeans, AcceptAnyNameOfThePopulationAxis) {
    const CsvTable results = parse_csv("point,p,seed,x\n0,A,1,5\n1,A,2,7\n2,B,1,6\n3,B,2,9\n", "table");
    ASSERT_TRUE(has_seeds(results));
    const CsvTable means = parse_csv(seed_means_csv(results, "p"), "means");
    ASSERT_EQ(means.rows.size(), 2u);
    EXPECT_EQ(means.columns[0], "p");
    EXPECT_NEAR(number(means, 1, "difference"), 1.5, 1e-9);
}

}  // namespace
}  // namespace stopline

#include "scenario/schema/quantity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <regex>
#include <set>
#include <stdexcept>

namespace stopline {
namespace {

double si(const char* text, const char* expected_unit) {
    const ParsedQuantity parsed = parse_quantity(text, unit(expected_unit));
    EXPECT_EQ(parsed.problem, "") << text;
    return parsed.si;
}

std::string problem(const char* text, const char* expected_unit) {
    return parse_quantity(text, unit(expected_unit)).problem;
}

TEST(Quantity, ConvertsToSi) {
    // No rounding difference is allowed here, because the defaults of the structs are written as 50.0 / 3.6.
    EXPECT_EQ(si("50 km/h", "km/h"), 50.0 / 3.6);
    EXPECT_EQ(si("13.5 m/s", "km/h"), 13.5);
    EXPECT_EQ(si("0.87 s", "s"), 0.87);
    EXPECT_EQ(si("10 ms", "s"), 0.01);
    EXPECT_EQ(si("2 min", "s"), 120.0);
    EXPECT_EQ(si("1.5 h", "s"), 5400.0);
    EXPECT_EQ(si("2.95 m", "m"), 2.95);
    EXPECT_EQ(si("295 cm", "m"), 2.95);
    EXPECT_EQ(si("2950 mm", "m"), 2.95);
    EXPECT_EQ(si("1.2 km", "m"), 1200.0);
    EXPECT_EQ(si("2.118 m2", "m2"), 2.118);
    EXPECT_EQ(si("2.5 m/s2", "m/s2"), 2.5);
    EXPECT_EQ(si("6 m/s3", "m/s3"), 6.0);
    EXPECT_EQ(si("1.235 t", "kg"), 1235.0);
    EXPECT_EQ(si("131 N m", "N m"), 131.0);
    EXPECT_EQ(si("2000 rpm", "rpm"), 2000.0);
    EXPECT_EQ(si("2000 1/min", "rpm"), 2000.0);
    EXPECT_EQ(si("0.7 1/s", "1/s"), 0.7);
    EXPECT_EQ(si("0.2 1/s2", "1/s2"), 0.2);
    EXPECT_EQ(si("5e-5 s/m", "s/m"), 5e-5);
    EXPECT_EQ(si("600 veh/h", "veh/h"), 600.0 / 3600.0);
    EXPECT_EQ(si("30 %", "%"), 0.3);
    EXPECT_EQ(si("0.3 fraction", "%"), 0.3);
    EXPECT_EQ(si("0.3", ""), 0.3);
}

TEST(Quantity, AcceptsCommonSpellings) {
    EXPECT_EQ(si("15s", "s"), 15.0);
    EXPECT_EQ(si("  15   s ", "s"), 15.0);
    EXPECT_EQ(si("+15 s", "s"), 15.0);
    EXPECT_EQ(si("-15 s", "s"), -15.0);
    EXPECT_EQ(si(".5 s", "s"), 0.5);
    EXPECT_EQ(si("5. s", "s"), 5.0);
    EXPECT_EQ(si("1.5e1 s", "s"), 15.0);
    EXPECT_EQ(si("131Nm", "N m"), 131.0);
    EXPECT_EQ(si("2.5 m/s^2", "m/s2"), 2.5);
    EXPECT_EQ(si("2.5 m/s²", "m/s2"), 2.5);
}

TEST(Quantity, RefusesWrongOrMissingUnits) {
    EXPECT_EQ(problem("15", "s"), "has no unit: write e.g. '15 s'");
    for (const char* text : {"15 s", "15 %", "0.15 fraction", "15 furlong"})
        EXPECT_EQ(problem(text, ""), "has a unit, but is a plain number") << text;
    EXPECT_EQ(problem("15 m", "s"), "is a length (unit 'm'), but a time is needed");
    EXPECT_EQ(problem("15 kmh", "km/h"), "has the unknown unit 'kmh' (known here: m/s, km/h)");
    EXPECT_EQ(problem("15 S", "s"), "has the unknown unit 'S' (known here: s, ms, min, h)");
    EXPECT_EQ(problem("50 %", "s"), "is a share (unit '%'), but a time is needed");
    EXPECT_EQ(problem("15 m", "%"), "is a length (unit 'm'), but a share is needed");
    EXPECT_EQ(problem("1,5 s", "s"), "has a comma: write a decimal point, and no thousands separators");
    EXPECT_EQ(problem("15 s s", "s"), "has the unknown unit 's s' (known here: s, ms, min, h)");
    EXPECT_EQ(problem("1 000 m", "m"), "has the unknown unit '000 m' (known here: m, cm, mm, km)");
}

TEST(Quantity, RefusesPercentagesWithoutUnit) {
    EXPECT_EQ(problem("1", "%"), "has no unit: write '1 %' or '100 %', whichever is meant");
    EXPECT_EQ(problem("0.07", "%"), "has no unit: write '0.07 %' or '7 %', whichever is meant");
    EXPECT_EQ(problem("10", "%"), "has no unit: write e.g. '10 %'");
    EXPECT_EQ(problem("0", "%"), "has no unit: write e.g. '0 %'");
    EXPECT_EQ(problem("-2", "%"), "has no unit: write e.g. '-2 %'");
    EXPECT_EQ(problem("5 per cent", "%"), "has the unknown unit 'per cent' (known here: %, fraction)");
}

TEST(Quantity, PlainSharesHaveAnyUnitOfAShareOrNone) {
    const Unit& share = unit(kPlainShare);
    for (const char* text : {"0.4", "40 %", "0.4 fraction"}) {
        EXPECT_EQ(parse_quantity(text, share).problem, "") << text;
        EXPECT_EQ(parse_quantity(text, share).si, 0.4) << text;
        EXPECT_TRUE(std::regex_match(text, std::regex(quantity_pattern(share)))) << text;
    }
    EXPECT_EQ(parse_quantity("0.4 s", share).problem, "is a time (unit 's'), but a share is needed");
    EXPECT_EQ(exact_text(0.4, share), "0.4");
}

// Not every number is a hundredth of another one. Such a percentage is written as a fraction.
TEST(Quantity, ExactTextOfAPercentageHasAUnit) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> share(0.0, 2.0);
    int fractions = 0;
    for (int i = 0; i < 2000; ++i) {
        const std::string text = exact_text(share(random), unit("%"));
        EXPECT_TRUE(text.ends_with(" %") || text.ends_with(" fraction")) << text;
        if (text.ends_with(" fraction")) ++fractions;
    }
    EXPECT_GT(fractions, 0);
}

TEST(Quantity, RefusesNonNumbers) {
    for (const char* text : {"", " ", "s", "abc", "-", "+", ".", "--5 s", "+-5 s", "- 5 s", "e5 s", "_1 s", "true"}) {
        EXPECT_EQ(problem(text, "s"), "is not a number") << text;
    }
    EXPECT_NE(problem("0x10 s", "s"), "");
    for (const char* text :
         {"nan", "NaN", ".nan", "-nan", "inf", "-inf", ".inf", "+.INF", "Infinity", "nan s", "inf s"}) {
        EXPECT_EQ(problem(text, "s"), "is not a finite number") << text;
    }
    EXPECT_EQ(problem("1e999 s", "s"), "is too large or too close to 0 for a number");
    EXPECT_EQ(problem("1e308 h", "s"), "is too large for a number");
}

TEST(Quantity, WholeNumbersAreDigitsOnly) {
    EXPECT_EQ(parse_whole("60").value, 60u);
    EXPECT_EQ(parse_whole(" 60 ").value, 60u);
    EXPECT_EQ(parse_whole("0").problem, "");
    EXPECT_EQ(parse_whole("18446744073709551615").value, std::numeric_limits<std::uint64_t>::max());
    for (const char* text :
         {"", "-1", "+1", "1.5", "1e3", "0x10", "6 0", "sixty", "18446744073709551616", "010", "00"}) {
        EXPECT_NE(parse_whole(text).problem, "") << text;
    }
}

// In every unit, the exact text of any number gives the same bits back.
TEST(Quantity, ExactTextRoundTrips) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> exponent(-12.0, 12.0);
    for (const Unit& shown : units()) {
        for (int i = 0; i < 2000; ++i) {
            const double value = std::pow(10.0, exponent(random)) * (i % 2 == 0 ? 1.0 : -1.0);
            const std::string text = exact_text(value, shown);
            const ParsedQuantity parsed = parse_quantity(text, shown);
            ASSERT_EQ(parsed.problem, "") << text;
            ASSERT_EQ(parsed.si, value) << text;
        }
    }
}

TEST(Quantity, ExactTextIsShort) {
    for (int kmh = 1; kmh <= 200; ++kmh) {
        EXPECT_EQ(exact_text(kmh / 3.6, unit("km/h")), std::to_string(kmh) + " km/h");
        EXPECT_EQ(exact_text(kmh / 100.0, unit("%")), std::to_string(kmh) + " %");
    }
    EXPECT_EQ(exact_text(0.87, unit("s")), "0.87 s");
    EXPECT_EQ(exact_text(0.0, unit("%")), "0 %");
    EXPECT_EQ(short_text(50.0 / 3.6, unit("km/h")), "50 km/h");
    EXPECT_EQ(short_text(1e6, unit("s")), "1000000 s");
}

TEST(Quantity, EverySpellingIsUniqueAndMatchesThePattern) {
    std::set<std::string_view> spellings;
    for (const Unit& candidate : units()) {
        EXPECT_TRUE(spellings.insert(candidate.text).second) << candidate.text;
        EXPECT_EQ(&unit(candidate.text), &candidate);
        EXPECT_FALSE(name_of(candidate.dimension).empty());
        const std::regex pattern(quantity_pattern(candidate));
        for (const char* number : {"1", "-2.5", ".5", "5.", "1e-3"}) {
            const std::string text = std::string(number) + " " + std::string(candidate.text);
            EXPECT_TRUE(std::regex_match(text, pattern)) << text;
            EXPECT_EQ(parse_quantity(text, candidate).problem, "") << text;
        }
        EXPECT_FALSE(std::regex_match("5 parsec", pattern));
        EXPECT_EQ(std::regex_match("5 fraction", pattern), candidate.dimension == Dimension::share);
        EXPECT_EQ(std::regex_match("5", pattern), candidate.text.empty());
    }
    EXPECT_THROW(unit("parsec"), std::logic_error);
}

}  // namespace
}  // namespace stopline

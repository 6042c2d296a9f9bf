// Loads the files data/paper/targets.csv and data/paper/own_rows.csv. Each row of the first file holds one input,
// target or claim of the paper. Each row of the second file names a result of ours that the paper does not have.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace stopline {

// One row of a file.
struct Target {
    std::string id;        // identifier of the row, such as L01
    std::string section;   // section of the paper, such as III.E or IV Table 1
    std::string scenario;  // scenario or experiment that gives the value; '-': none
    std::string kind;      // input: assumed value; target: numerical result; claim: statement in words;
                           // own: result of ours without a value in the paper
    std::string quantity;
    std::string condition;  // population and settings; for an input: the objects that have the value
    std::string value;      // value in the paper: a number, a range 'low..high', or the text of a claim
    std::string unit;
    std::string tolerance;       // allowed difference: a number, or empty
    std::string tolerance_kind;  // abs (in the unit), % (of the value) or max (the value is an upper limit)
    std::string note;
};

// Loads the rows of a file. Throws InputError if the file cannot be read, a column is missing or an id appears twice.
std::vector<Target> load_targets(const std::filesystem::path& file);
// Loads the rows of data/paper/targets.csv.
std::vector<Target> load_targets();
// Loads the rows of data/paper/own_rows.csv.
std::vector<Target> load_own_rows();

// Returns true if the row belongs to the section of the paper or to a part of it. Section III includes III.B, and
// section IV includes IV Table 1. Section I does not include III or IV.
bool in_section(const Target& target, const std::string& section);

// A condition such as "CDG green=15" or "SWITCH-1 green>=20". The word "alternating" after the population is ignored.
struct GreenCondition {
    std::string population;
    double green_s = 0.0;
    bool and_above = false;  // true for green>=, false for green=
};
// Parses the condition of a row. Returns std::nullopt if the text has another form.
std::optional<GreenCondition> parse_green_condition(const std::string& condition);

// A condition such as "CDG green=15 left=0 right=30", with turn shares in percent. The population MIX becomes P50,
// which is its name in the scenarios.
struct TurnCondition {
    std::string population;
    double green_s = 0.0;
    double left_percent = 0.0;
    double right_percent = 0.0;
};
// Parses the condition of a row. Returns std::nullopt if the text has another form.
std::optional<TurnCondition> parse_turn_condition(const std::string& condition);

}  // namespace stopline

// The inputs, results and claims of the paper from data/paper/targets.csv, one per row.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace stopline {

struct Target {
    std::string id;        // such as L01
    std::string section;   // section of the paper, such as III.E or IV Table 1
    std::string scenario;  // scenario in which the row is measured
    std::string kind;      // input, target, claim
    std::string quantity;
    std::string condition;  // population and settings; for an input: what it applies to
    std::string value;      // value in the paper: a number, a range 'low..high', or the text of a claim
    std::string unit;
    std::string tolerance;       // a number or empty
    std::string tolerance_kind;  // abs (in the unit), % (of the value), max (the value must not be exceeded)
    std::string note;
};

// Loads the rows. Throws InputError if the file cannot be read, a column is missing or an id appears twice.
std::vector<Target> load_targets(const std::filesystem::path& file);
// Loads data/paper/targets.csv.
std::vector<Target> load_targets();

// Returns true if the row is in the section or in a part of it. Section III includes III.B, and section IV includes
// IV Table 1; section I includes neither.
bool in_section(const Target& target, const std::string& section);

// A condition such as "CDG green=15" or "SWITCH-1 green>=20". The word "alternating" after the population is dropped.
struct GreenCondition {
    std::string population;
    double green_s = 0.0;
    bool and_above = false;  // green>=
};
// Returns the parsed condition, or nothing if the text has another form.
std::optional<GreenCondition> parse_green_condition(const std::string& condition);

// A condition such as "CDG green=15 left=0 right=30", with turn shares in percent. MIX becomes the population P50.
struct TurnCondition {
    std::string population;
    double green_s = 0.0;
    double left_percent = 0.0;
    double right_percent = 0.0;
};
// Returns the parsed condition, or nothing if the text has another form.
std::optional<TurnCondition> parse_turn_condition(const std::string& condition);

}  // namespace stopline

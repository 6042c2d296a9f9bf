// The numbers and claims of the paper, data/paper/targets.csv, one a row, and what is said beside them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace stopline {

struct Target {
    std::string id;        // L01
    std::string section;   // of the paper: III.E, IV Table 1
    std::string scenario;  // that the row is measured in
    std::string kind;      // input, target, claim
    std::string quantity;
    std::string condition;  // population and settings; for inputs what they hold for
    std::string value;      // of the paper: a number, a range 'low..high', or the text of a claim
    std::string unit;
    std::string tolerance;       // a number or empty
    std::string tolerance_kind;  // abs (in the unit), % (of the value), max (the value must not be exceeded)
    std::string note;
};

// Throws InputError where the file cannot be read or a row cannot be understood.
std::vector<Target> load_targets(const std::filesystem::path& file);
std::vector<Target> load_targets();  // of the data directory

// Whether a row belongs to what the user asked for: 'III' means III itself and all below it (III.B), 'IV' has 'IV Table 1'
// too, and 'I' has neither.
bool in_section(const Target& target, const std::string& section);

// "CDG green=15" and "SWITCH-1 green>=20"; the word "alternating" says how MIX is arranged and is not part of the name.
struct GreenCondition {
    std::string population;
    double green_s = 0.0;
    bool and_above = false;  // green>=
};
std::optional<GreenCondition> parse_green_condition(const std::string& condition);

// "CDG green=15 left=0 right=30", in percent; MIX is the population P50.
struct TurnCondition {
    std::string population;
    double green_s = 0.0;
    double left_percent = 0.0;
    double right_percent = 0.0;
};
std::optional<TurnCondition> parse_turn_condition(const std::string& condition);

// A number, or nothing where the whole text is not one.
std::optional<double> parse_number(const std::string& text);

}  // namespace stopline

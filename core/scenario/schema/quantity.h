// Quantities with units, as files write them: "50 km/h", "0.87 s", "2.5 m/s2", "30 %".
//
// A missing unit is an error, never a guess. A unit of the wrong dimension is an error too, and so is a unit on a plain
// number. All values are converted to SI here. Engine speeds stay in rpm, as in the settings.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stopline {

enum class Dimension {
    number,
    time,
    length,
    area,
    speed,
    acceleration,
    jerk,
    mass,
    torque,
    engine_speed,
    rate,             // 1/s
    rate_squared,     // 1/s2
    time_per_length,  // s/m
    flow,             // vehicles/s
};

struct Unit {
    std::string_view text;
    Dimension dimension;
    // SI value = value * multiply / divide. With two factors, 50 km/h gives exactly 50 / 3.6.
    double multiply = 1.0;
    double divide = 1.0;
};

// Returns all units, with each spelling as an entry of its own.
const std::vector<Unit>& units();
// Returns the unit with this spelling; "" and "%" are plain numbers. Throws std::logic_error for any other text.
const Unit& unit(std::string_view text);
std::string_view name_of(Dimension dimension);  // "time", "length", ...

double to_si(double value, const Unit& in);
double from_si(double si, const Unit& in);

// `problem` is empty for a finite quantity of the expected dimension. Else it ends the sentence "value '...' ".
struct ParsedQuantity {
    double si = 0.0;
    std::string problem;
};
ParsedQuantity parse_quantity(std::string_view text, const Unit& expected);

// A whole number without unit, from 0 to 2^64 - 1.
struct ParsedWhole {
    unsigned long long value = 0;
    std::string problem;
};
ParsedWhole parse_whole(std::string_view text);

// Returns the shortest text in `unit` from which parse_quantity gives exactly `si`, or such a text in the SI unit.
std::string exact_text(double si, const Unit& unit);
// Returns a text with seven significant digits.
std::string short_text(double si, const Unit& unit);

// Returns a regular expression (ECMA 262) for quantities of a dimension, for the JSON schema.
std::string quantity_pattern(Dimension dimension);

}  // namespace stopline

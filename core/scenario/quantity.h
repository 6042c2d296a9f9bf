// Quantities as people write them: "50 km/h", "0.87 s", "2.5 m/s2", "30 %". A unit is never guessed: a bare number where
// one is needed is an error, and so is a unit of another dimension or one on a plain number. Everything is converted to SI
// here, once; engine speeds stay in rpm, as the settings hold them.
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
    double multiply = 1.0;  // SI = value * multiply / divide; two factors, so that 50 km/h is exactly 50 / 3.6
    double divide = 1.0;
};

// All units that can be written, several spellings of one included.
const std::vector<Unit>& units();
// The unit of that spelling ("" and "%": plain numbers); a spelling that is not in the list is a programmer's error.
const Unit& unit(std::string_view text);
std::string_view name_of(Dimension dimension);  // "time", "length", ...

double to_si(double value, const Unit& in);
double from_si(double si, const Unit& in);

// `problem` is empty if the text is a finite quantity of the unit's dimension; else it continues "value '...' ".
struct ParsedQuantity {
    double si = 0.0;
    std::string problem;
};
ParsedQuantity parse_quantity(std::string_view text, const Unit& expected);

// A whole number without unit, 0 .. 2^64 - 1.
struct ParsedWhole {
    unsigned long long value = 0;
    std::string problem;
};
ParsedWhole parse_whole(std::string_view text);

// The shortest text in `shown` that parse_quantity turns into exactly `si` again; in the SI unit where none does.
std::string exact_text(double si, const Unit& shown);
// For people: seven significant digits.
std::string short_text(double si, const Unit& shown);

// A regular expression (ECMA 262) for quantities of a dimension, for the JSON schema.
std::string quantity_pattern(Dimension dimension);

}  // namespace stopline

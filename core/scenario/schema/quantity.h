// Quantities with units, as files write them: "50 km/h", "0.87 s", "2.5 m/s2", "30 %".
//
// A quantity must have a unit; none is assumed, not even for 0. A unit of the wrong dimension is an error. A share is
// written as 30 % or as 0.3 fraction. A plain number, such as a platoon size, has no unit. A few
// shares may be given without unit, such as `dawdling` of the Krauss model, because the literature does so
// (kPlainShare). All values are converted to SI units, except engine
// speeds, which stay in rpm, and fuel rates, which stay in g/h.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stopline {

enum class Dimension {
    number,
    share,
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
    power,
    voltage,
    resistance,  // electric
    density,
    fuel_rate,  // g/h
};

struct Unit {
    std::string_view text;
    Dimension dimension;
    // SI value = value * multiply / divide. There are two numbers, because a single factor such as 1 / 3.6 for km/h
    // would be rounded.
    double multiply = 1.0;
    double divide = 1.0;
};

// Returns all units. Each spelling has an entry of its own, such as m2 and m^2.
const std::vector<Unit>& units();
// Returns the unit with this spelling; "" is the unit of plain numbers, and kPlainShare that of shares whose unit is
// optional. Throws std::logic_error if there is no such unit.
const Unit& unit(std::string_view text);
// Unit of a share whose unit is optional: 0.4, 40 % and 0.4 fraction are the same value. Its text is empty.
inline constexpr std::string_view kPlainShare = "plain share";
std::string_view name_of(Dimension dimension);  // "time", "length", ...

double to_si(double value, const Unit& in);
double from_si(double si, const Unit& in);

// The result of parse_quantity(). `problem` is empty for a finite quantity of the expected dimension. Otherwise
// `problem` completes the sentence "value '...' ...", such as "has no unit".
struct ParsedQuantity {
    double si = 0.0;
    std::string problem;
};
ParsedQuantity parse_quantity(std::string_view text, const Unit& expected);

// The result of parse_whole(): a whole number without unit, from 0 to 2^64 - 1, or a problem as in ParsedQuantity.
struct ParsedWhole {
    unsigned long long value = 0;
    std::string problem;
};
ParsedWhole parse_whole(std::string_view text);

// Returns a text from which parse_quantity() gives exactly `si`. The text is in `unit` if possible, else in the SI
// unit.
std::string exact_text(double si, const Unit& unit);
// Returns the value in `unit` as text, rounded to seven significant digits.
std::string short_text(double si, const Unit& unit);

// Returns a regular expression (ECMA 262) that matches quantities for a field with this unit. The JSON schema uses it.
std::string quantity_pattern(const Unit& unit);

}  // namespace stopline

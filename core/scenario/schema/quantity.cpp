#include "scenario/schema/quantity.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <system_error>

#include "base/nearest_name.h"

namespace stopline {
namespace {

struct DimensionName {
    Dimension dimension;
    std::string_view name;
};

constexpr std::array kDimensionNames{
    DimensionName{Dimension::number, "plain number"},
    DimensionName{Dimension::share, "share"},
    DimensionName{Dimension::time, "time"},
    DimensionName{Dimension::length, "length"},
    DimensionName{Dimension::area, "area"},
    DimensionName{Dimension::speed, "speed"},
    DimensionName{Dimension::acceleration, "acceleration"},
    DimensionName{Dimension::jerk, "jerk"},
    DimensionName{Dimension::mass, "mass"},
    DimensionName{Dimension::torque, "torque"},
    DimensionName{Dimension::engine_speed, "engine speed"},
    DimensionName{Dimension::rate, "rate"},
    DimensionName{Dimension::rate_squared, "squared rate"},
    DimensionName{Dimension::time_per_length, "time per length"},
    DimensionName{Dimension::flow, "flow of vehicles"},
    DimensionName{Dimension::power, "power"},
    DimensionName{Dimension::voltage, "voltage"},
    DimensionName{Dimension::resistance, "electric resistance"},
    DimensionName{Dimension::density, "density"},
    DimensionName{Dimension::fuel_rate, "fuel rate"},
};

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

bool is_word_for_non_finite(std::string_view text) {
    std::string word;
    for (const char c : text) {
        if (c != '.' && c != '+' && c != '-') word += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    }
    return word == "nan" || word == "inf" || word == "infinity" || word.starts_with("inf ") || word.starts_with("nan ");
}

// Reads the decimal number at the start of `text` and removes it from `text`. Returns a problem as in ParsedQuantity.
std::string take_number(std::string_view& text, double& value) {
    if (is_word_for_non_finite(text)) return "is not a finite number";
    const std::size_t sign = text.starts_with('+') || text.starts_with('-') ? 1 : 0;
    const char first = text.size() > sign ? text[sign] : ' ';
    if ((first < '0' || first > '9') && first != '.') return "is not a number";
    if (text.front() == '+') text.remove_prefix(1);  // from_chars accepts no plus sign
    const char* const begin = text.data();
    const auto [end, error] = std::from_chars(begin, begin + text.size(), value);
    if (error == std::errc::result_out_of_range) return "is too large or too close to 0 for a number";
    if (error != std::errc()) return "is not a number";
    text.remove_prefix(static_cast<std::size_t>(end - begin));
    if (text.starts_with(',')) return "has a comma: write a decimal point, and no thousands separators";
    return {};
}

std::string digits(double value) {
    std::array<char, 40> text{};
    const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() ? std::string(text.data(), end) : std::string();
}

// Returns the problem of a number without unit. A plain number from 0 to 1 for a percentage could mean a fraction, too.
std::string missing_unit(double value, std::string_view number, const Unit& expected) {
    const std::string written = "'" + shortened(number) + " " + std::string(expected.text) + "'";
    if (expected.text != "%" || value <= 0.0 || value > 1.0) return "has no unit: write e.g. " + written;
    return "has no unit: write " + written + " or '" + short_text(value, expected) + "', whichever is meant";
}

std::string unit_problem(std::string_view written, const Unit& expected) {
    if (expected.dimension == Dimension::number) return "has a unit, but is a plain number";
    std::vector<std::string> spellings;
    for (const Unit& candidate : units()) {
        if (candidate.text == written) {
            return "is a " + std::string(name_of(candidate.dimension)) + " (unit '" + std::string(written) +
                   "'), but a " + std::string(name_of(expected.dimension)) + " is needed";
        }
        if (candidate.dimension == expected.dimension && !candidate.text.empty()) {
            spellings.emplace_back(candidate.text);
        }
    }
    return "has the unknown unit '" + shortened(written) + "' (known here: " + joined(spellings) + ")";
}

std::string with_unit(const std::string& number, const Unit& in) {
    if (in.text.empty()) return number;
    return number + " " + std::string(in.text);
}

}  // namespace

const std::vector<Unit>& units() {
    // The first unit of each dimension without a factor is the SI unit, rpm for engine speeds, g/h for fuel rates, or
    // `fraction`. exact_text() relies on this order.
    static const std::vector<Unit> all{
        {"", Dimension::number},
        {"%", Dimension::share, 1.0, 100.0},
        {"fraction", Dimension::share},
        {"s", Dimension::time},
        {"ms", Dimension::time, 1.0, 1000.0},
        {"min", Dimension::time, 60.0},
        {"h", Dimension::time, 3600.0},
        {"m", Dimension::length},
        {"cm", Dimension::length, 1.0, 100.0},
        {"mm", Dimension::length, 1.0, 1000.0},
        {"km", Dimension::length, 1000.0},
        {"m2", Dimension::area},
        {"m^2", Dimension::area},
        {"m²", Dimension::area},
        {"m/s", Dimension::speed},
        {"km/h", Dimension::speed, 1.0, 3.6},
        {"m/s2", Dimension::acceleration},
        {"m/s^2", Dimension::acceleration},
        {"m/s²", Dimension::acceleration},
        {"m/s3", Dimension::jerk},
        {"m/s^3", Dimension::jerk},
        {"m/s³", Dimension::jerk},
        {"kg", Dimension::mass},
        {"t", Dimension::mass, 1000.0},
        {"N m", Dimension::torque},
        {"Nm", Dimension::torque},
        {"rpm", Dimension::engine_speed},
        {"1/min", Dimension::engine_speed},
        {"1/s", Dimension::rate},
        {"1/s2", Dimension::rate_squared},
        {"1/s^2", Dimension::rate_squared},
        {"1/s²", Dimension::rate_squared},
        {"s/m", Dimension::time_per_length},
        {"veh/s", Dimension::flow},
        {"veh/h", Dimension::flow, 1.0, 3600.0},
        {"W", Dimension::power},
        {"kW", Dimension::power, 1000.0},
        {"V", Dimension::voltage},
        {"ohm", Dimension::resistance},
        {"kg/m3", Dimension::density},
        {"g/l", Dimension::density},
        {"g/h", Dimension::fuel_rate},
        {"kg/h", Dimension::fuel_rate, 1000.0},
    };
    return all;
}

const Unit& unit(std::string_view text) {
    static const Unit plain_share{"", Dimension::share};
    if (text == kPlainShare) return plain_share;
    for (const Unit& candidate : units()) {
        if (candidate.text == text) return candidate;
    }
    throw std::logic_error("no unit '" + std::string(text) + "' in quantity.cpp");
}

std::string_view name_of(Dimension dimension) {
    const auto* const found = std::find_if(kDimensionNames.begin(), kDimensionNames.end(),
                                           [=](const DimensionName& d) { return d.dimension == dimension; });
    return found->name;
}

double to_si(double value, const Unit& in) { return value * in.multiply / in.divide; }
double from_si(double si, const Unit& in) { return si * in.divide / in.multiply; }

ParsedQuantity parse_quantity(std::string_view text, const Unit& expected) {
    ParsedQuantity result;
    std::string_view rest = trimmed(text);
    double value = 0.0;
    result.problem = take_number(rest, value);
    if (!result.problem.empty()) return result;
    const std::string_view written = trimmed(rest);
    if (written.empty()) {
        result.si = value;
        if (!expected.text.empty()) result.problem = missing_unit(value, trimmed(text), expected);
        return result;
    }
    for (const Unit& candidate : units()) {
        if (candidate.dimension != expected.dimension || candidate.text != written) continue;
        result.si = to_si(value, candidate);
        if (!std::isfinite(result.si)) result.problem = "is too large for a number";
        return result;
    }
    result.problem = unit_problem(written, expected);
    return result;
}

ParsedWhole parse_whole(std::string_view text) {
    ParsedWhole result;
    const std::string_view number = trimmed(text);
    if (number.size() > 1 && number.front() == '0' &&
        number.find_first_not_of("0123456789") == std::string_view::npos) {
        result.problem = "begins with 0, which some readers take for an octal number: remove the 0";
        return result;
    }
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), result.value);
    if (error == std::errc::result_out_of_range) {
        result.problem = "is above the maximum of " + std::to_string(std::numeric_limits<std::uint64_t>::max());
    } else if (error != std::errc() || end != number.data() + number.size()) {
        result.problem = "is not a whole number (digits only)";
    }
    return result;
}

std::string exact_text(double si, const Unit& unit) {
    const auto parses_back = [&](const std::string& text) {
        const ParsedQuantity parsed = parse_quantity(text, unit);
        return parsed.problem.empty() && parsed.si == si;
    };
    // The exact conversion may end in a rounding error such as 35.00000000000001, so a value with 14 digits is tried
    // first.
    std::array<char, 40> rounded{};
    const auto [end, error] = std::to_chars(rounded.data(), rounded.data() + rounded.size(), from_si(si, unit),
                                            std::chars_format::general, 14);
    double rounded_value = 0.0;
    if (error == std::errc()) std::from_chars(rounded.data(), end, rounded_value);
    for (const double value : {rounded_value, from_si(si, unit)}) {
        const std::string text = with_unit(digits(value), unit);
        if (parses_back(text)) return text;
    }
    const auto is_base = [&](const Unit& candidate) {
        return candidate.dimension == unit.dimension && !candidate.text.empty() &&
               candidate.multiply == candidate.divide;
    };
    return with_unit(digits(si), *std::find_if(units().begin(), units().end(), is_base));
}

std::string short_text(double si, const Unit& unit) {
    std::array<char, 40> text{};
    const auto [end, error] =
        std::to_chars(text.data(), text.data() + text.size(), from_si(si, unit), std::chars_format::general, 7);
    return with_unit(error == std::errc() ? std::string(text.data(), end) : std::string(), unit);
}

std::string quantity_pattern(const Unit& unit) {
    std::string spellings;
    for (const Unit& candidate : units()) {
        if (candidate.dimension != unit.dimension || candidate.text.empty()) continue;
        if (!spellings.empty()) spellings += '|';
        for (const char c : candidate.text) {
            if (c == '^') spellings += '\\';
            spellings += c;
        }
    }
    const std::string unit_part = spellings.empty() ? "" : "(" + spellings + ")" + (unit.text.empty() ? "?" : "");
    return "^ *[-+]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][-+]?[0-9]+)? *" + unit_part + " *$";
}

}  // namespace stopline

// Our answer to a row of the paper, and the verdict if it lies inside the tolerance of the row.
#pragma once

#include <optional>
#include <string>

#include "reference/targets.h"

namespace stopline {

enum class Verdict {
    inside,  // within the tolerance, or a claim that holds
    miss,    // outside the tolerance, or a claim that does not hold
    open     // not measured, or the row states no tolerance
};
const char* to_string(Verdict verdict);

// A number has low = high. A range is judged at both ends. A claim is judged by `holds`.
struct Answer {
    double low = 0.0;
    double high = 0.0;
    std::optional<bool> holds;  // only for claims
    std::string text;           // text for tables
};
Answer number_answer(double value);
Answer range_answer(double low, double high);
Answer claim_answer(bool holds, std::string text);

// Value of the paper. low = high if the paper gives one number.
struct TargetRange {
    double low = 0.0;
    double high = 0.0;
};
std::optional<TargetRange> parse_range(const std::string& value);  // accepts "17" and "20..45"

// Judges an answer. NaN is a miss: it was measured without a result. Throws InputError if the value of the row is not a
// number or its kind of tolerance is unknown.
Verdict judge(const Target& target, const std::optional<Answer>& answer);

// Returns "±1", "±6 %", "exact" or "max", or an empty text if the row states no tolerance.
std::string tolerance_text(const Target& target);

}  // namespace stopline

// Our answer to a row of the paper, and whether it lies inside the row's tolerance.
#pragma once

#include <optional>
#include <string>

#include "experiment/targets.h"

namespace stopline {

enum class Verdict {
    inside,  // within the tolerance; a claim that holds; an input that is the paper's
    miss,
    open  // not measured yet, or the row states no tolerance to judge by
};
const char* to_string(Verdict verdict);

// A number has low = high. A range is judged at both ends, and a claim by whether it holds.
struct Answer {
    double low = 0.0;
    double high = 0.0;
    std::optional<bool> holds;  // of a claim
    std::string text;           // as it is shown
};
Answer number_answer(double value);
Answer range_answer(double low, double high);
Answer claim_answer(bool holds, std::string text);

// What a row demands of a number: low = high where the paper gives one number.
struct TargetRange {
    double low = 0.0;
    double high = 0.0;
};
std::optional<TargetRange> parse_range(const std::string& value);  // "17", "20..45"

// NaN is a miss: it was measured, and there was nothing to find. Throws InputError where the row cannot be understood (a value
// that is no number, an unknown kind of tolerance).
Verdict judge(const Target& target, const std::optional<Answer>& answer);

// "±1", "±6 %", "max", or "" where the row states none.
std::string tolerance_text(const Target& target);

}  // namespace stopline

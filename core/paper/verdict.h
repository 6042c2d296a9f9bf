// Our answer to a row of the scorecard, and the verdict on this answer: inside or outside the tolerance of the row.
#pragma once

#include <optional>
#include <string>

#include "reference/targets.h"

namespace stopline {

enum class Verdict {
    inside,  // our value is within the tolerance, or the claim holds
    miss,    // our value is outside the tolerance, or the claim does not hold
    open,    // we have no value, or the row states no tolerance
    input,   // the row is an input of the paper, and our input has the same value
    own      // the row is a result of ours without a value in the paper, measured or not
};
const char* to_string(Verdict verdict);

// Our answer: a number (low = high), a range from low to high, or a yes or no to a claim (`holds`).
struct Answer {
    double low = 0.0;
    double high = 0.0;
    std::optional<bool> holds;  // set only for claims: true if the claim holds in our runs
    std::string text;           // the answer as shown in tables
};
Answer number_answer(double value);
Answer range_answer(double low, double high);
Answer claim_answer(bool holds, std::string text);

// Value in the paper: a range from low to high. A single number has low = high.
struct TargetRange {
    double low = 0.0;
    double high = 0.0;
};
// Parses a number such as "17" or a range such as "20..45". Returns std::nullopt for other texts.
std::optional<TargetRange> parse_range(const std::string& value);

// Compares our answer with the row. The number NaN gives the verdict 'miss', because it means that the experiment ran
// but gave no number. Throws InputError if the value, the tolerance or the kind of tolerance of the row is invalid, or
// if a row of kind 'claim' has an answer without `holds`.
Verdict judge(const Target& target, const std::optional<Answer>& answer);

// Returns the tolerance of a row as text: "±1", "±6 %", "exact" or "max". "max" means that our value must not exceed
// the value of the paper. Returns an empty text if the row states no tolerance.
std::string tolerance_text(const Target& target);

}  // namespace stopline

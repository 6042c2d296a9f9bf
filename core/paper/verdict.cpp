#include "paper/verdict.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/csv.h"

namespace stopline {

namespace {

// Relative margin for rounding errors of unit conversions.
constexpr double kRounding = 1e-9;

std::string short_number(double value) { return std::isnan(value) ? "none" : fmt::format("{:.4g}", value); }

[[noreturn]] void refuse(const Target& target, const std::string& what) {
    throw InputError(fmt::format("data/paper/targets.csv: row {}: {}", target.id, what));
}

// Returns how far our value may lie from `value`, which is the value in the paper, in the unit of the row.
double band(const Target& target, double value, double tolerance) {
    if (target.tolerance_kind == "abs") return tolerance;
    if (target.tolerance_kind == "%") return 0.01 * tolerance * std::abs(value);
    refuse(target, fmt::format("unknown kind of tolerance '{}' (allowed: abs, %, max)", target.tolerance_kind));
}

bool near(const Target& target, double ours, double value, double tolerance) {
    return std::abs(ours - value) <= band(target, value, tolerance) + kRounding * (1.0 + std::abs(value));
}

}  // namespace

const char* to_string(Verdict verdict) {
    switch (verdict) {
        case Verdict::inside:
            return "inside";
        case Verdict::miss:
            return "miss";
        case Verdict::input:
            return "input";
        case Verdict::own:
            return "own";
        case Verdict::open:
            break;
    }
    return "open";
}

Answer number_answer(double value) { return {value, value, std::nullopt, short_number(value)}; }

Answer range_answer(double low, double high) {
    return {low, high, std::nullopt, short_number(low) + ".." + short_number(high)};
}

Answer claim_answer(bool holds, std::string text) { return {0.0, 0.0, holds, std::move(text)}; }

std::optional<TargetRange> parse_range(const std::string& value) {
    const std::size_t dots = value.find("..");
    const std::optional<double> low = parse_number(value.substr(0, dots));
    const std::optional<double> high = dots == std::string::npos ? low : parse_number(value.substr(dots + 2));
    if (!low || !high || *low > *high) return std::nullopt;
    return TargetRange{*low, *high};
}

Verdict judge(const Target& target, const std::optional<Answer>& answer) {
    if (target.kind == "own") return Verdict::own;
    if (!answer) return Verdict::open;
    if (answer->holds) return *answer->holds ? Verdict::inside : Verdict::miss;
    if (target.kind == "claim") refuse(target, "a claim needs a yes-or-no answer");
    if (target.tolerance.empty() && target.tolerance_kind != "max") return Verdict::open;
    const std::optional<TargetRange> paper = parse_range(target.value);
    if (!paper) refuse(target, fmt::format("value '{}' must be a number or a range such as 20..45", target.value));
    const std::optional<double> tolerance = target.tolerance.empty() ? 0.0 : parse_number(target.tolerance);
    if (!tolerance || *tolerance < 0.0)
        refuse(target, fmt::format("tolerance '{}' must be a number of 0 or more", target.tolerance));
    if (std::isnan(answer->low) || std::isnan(answer->high)) return Verdict::miss;
    if (target.tolerance_kind == "max") {
        const bool below = answer->high <= paper->high + *tolerance + kRounding * (1.0 + std::abs(paper->high));
        return below ? Verdict::inside : Verdict::miss;
    }
    // If our answer is a number, it must lie in the range of the paper or within the tolerance of one of its ends. If
    // our answer is a range, each of its ends must be within the tolerance of the same end of the paper's range.
    const bool is_number = answer->low == answer->high;
    const bool in_range = is_number && answer->low >= paper->low && answer->low <= paper->high;
    const bool low_near = near(target, answer->low, paper->low, *tolerance);
    const bool high_near = near(target, answer->high, paper->high, *tolerance);
    const bool inside = in_range || (is_number ? low_near || high_near : low_near && high_near);
    if (!inside) return Verdict::miss;
    return target.kind == "input" ? Verdict::input : Verdict::inside;
}

std::string tolerance_text(const Target& target) {
    if (target.tolerance_kind == "max") return "max";
    if (target.tolerance.empty()) return "";
    if (parse_number(target.tolerance) == 0.0) return "exact";
    return "±" + target.tolerance + (target.tolerance_kind == "%" ? " %" : "");
}

}  // namespace stopline

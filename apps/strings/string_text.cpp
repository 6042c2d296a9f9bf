#include "strings/string_text.h"

#include <cmath>

#include <fmt/format.h>

#include "base/nan.h"
#include "base/units.h"
#include "common/text_table.h"

namespace stopline {

namespace {

constexpr double kPercent = 100.0;
constexpr double kMilliseconds = 1e3;

// Returns the number of followers after which an oscillation has doubled; "-" if it does not grow.
std::string doubling_cell(double gain) {
    const double followers = std::isnan(gain) ? kNan : doubling_followers(gain);
    return std::isfinite(followers) ? fmt::format("{:.0f}", std::floor(followers)) : "-";
}

std::string position_cell(int position) { return position > 0 ? std::to_string(position) : "-"; }

std::string gains_text(const StringReport& report) {
    std::vector<std::vector<std::string>> rows;
    std::vector<std::string> names{"frequency [rad/s]"};
    std::vector<std::string> kinds{""};
    for (const StringResult& result : report.populations) {
        names.insert(names.end(), {result.population, ""});
        kinds.insert(kinds.end(), {"measured", "linear"});
    }
    rows.push_back(names);
    rows.push_back(kinds);
    const std::size_t frequencies = report.populations[0].swings.size();
    for (std::size_t k = 0; k < frequencies; ++k) {
        std::vector<std::string> cells{fmt::format("{:.3f}", report.populations[0].swings[k].frequency_radps)};
        for (const StringResult& result : report.populations) {
            cells.push_back(number_cell(result.swings[k].measured.mean, 4));
            cells.push_back(number_cell(result.swings[k].linear_gain, 4));
        }
        rows.push_back(cells);
    }
    return frequencies == 0 ? ""
                            : "Gain |Gamma| of the acceleration from vehicle to vehicle\n" + table_text(rows) + "\n";
}

std::string peaks_text(const StringReport& report) {
    std::vector<std::vector<std::string>> rows{{"", "peak", "at [rad/s]", "linear peak", "at [rad/s]", "doubles after",
                                                "linear", "time gap [s]", "smallest stable", "lag [s]"}};
    for (const StringResult& result : report.populations) {
        const SwingResult* const worst = result.worst_swing();
        if (worst == nullptr) return "";
        rows.push_back({result.population, number_cell(worst->measured.mean, 4), number_cell(worst->frequency_radps, 2),
                        number_cell(result.linear_peak.gain, 4), number_cell(result.linear_peak.frequency_radps, 2),
                        doubling_cell(worst->measured.mean), doubling_cell(result.linear_peak.gain),
                        number_cell(result.model ? result.model->time_gap_s : kNan, 2),
                        number_cell(result.stable_time_gap_s, 2), number_cell(result.follower_lag_s, 3)});
    }
    return "Largest gain, and number of followers after which an oscillation with this gain has doubled\n" +
           table_text(rows) + "\n";
}

std::string manoeuvres_text(const StringReport& report) {
    std::vector<std::vector<std::string>> rows{{"", "manoeuvre", "grows from position", "holds for followers",
                                                "gap error [m]", "smallest gap [m]", "standstill gap used",
                                                "jerk [m/s3]"}};
    const auto add = [&](const std::string& population, const std::string& name, const StringMeasures& m) {
        rows.push_back({population, name, position_cell(m.first_growing_position), std::to_string(m.holding_followers),
                        number_cell(m.largest_gap_error_m, 2), number_cell(m.smallest_gap_m, 2),
                        fmt::format("{:.0f} %", kPercent * m.largest_used_share), number_cell(m.largest_jerk_mps3, 1)});
    };
    for (const StringResult& result : report.populations) {
        if (const SwingResult* const worst = result.worst_swing()) {
            add(result.population, fmt::format("swing, {:.2f} rad/s", worst->frequency_radps), worst->measures);
        }
        for (const ManoeuvreResult& one : result.manoeuvres) {
            add(result.population, manoeuvre_name(one.kind), one.measures);
        }
    }
    return "Manoeuvres of the platoon leader\n" + table_text(rows) + "\n" +
           wrap_text(
               "A manoeuvre grows from the first vehicle whose largest acceleration exceeds that of its leader. It holds "
               "as long as the largest acceleration is at most twice that of the platoon leader.",
               kConsoleWidth, 0) +
           "\n";
}

}  // namespace

std::string string_text(const StringReport& report) {
    std::string text = gains_text(report) + peaks_text(report) + manoeuvres_text(report);
    for (const StringResult& result : report.populations) {
        if (!result.was_settled) {
            text += fmt::format("\nnote: {} had not reached its equilibrium before a manoeuvre\n", result.population);
        }
        const Violations& v = result.violations;
        if (!v.none()) text += fmt::format("\nERROR: {}: {} overlaps\n", result.population, v.overlaps);
    }
    return text;
}

std::string string_sweep_text(const StringSweep& sweep) {
    std::vector<std::vector<std::string>> rows{
        {"V2V delay [ms]", "time gap [s]", "peak", "at [rad/s]", "linear peak", "at [rad/s]"}};
    for (const StringSweepPoint& one : sweep.points) {
        rows.push_back({number_cell(kMilliseconds * one.v2v_delay_s, 0), number_cell(one.time_gap_s, 2),
                        number_cell(one.measured_gain, 4), number_cell(one.measured_frequency_radps, 2),
                        number_cell(one.linear.gain, 4), number_cell(one.linear.frequency_radps, 2)});
    }
    std::string text =
        fmt::format("Largest gain of {}\n{}\nBorder of string stability: smallest time gap without growth\n",
                    sweep.population, table_text(rows));
    rows = {{"V2V delay [ms]", "measured [s]", "linear [s]"}};
    for (const StringBorder& one : sweep.border) {
        rows.push_back({number_cell(kMilliseconds * one.v2v_delay_s, 0), number_cell(one.measured_time_gap_s, 2),
                        number_cell(one.linear_time_gap_s, 2)});
    }
    text += table_text(rows);
    if (!sweep.violations.none()) text += fmt::format("\nERROR: {} overlaps\n", sweep.violations.overlaps);
    return text;
}

}  // namespace stopline

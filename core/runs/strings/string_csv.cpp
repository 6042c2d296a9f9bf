#include "runs/strings/string_csv.h"

#include <cmath>

#include "base/io/csv.h"
#include "base/nan.h"

namespace stopline {

namespace {

constexpr double kPercent = 100.0;

// Returns an empty text for an infinite or missing number of followers.
std::string followers(double number) { return std::isfinite(number) ? fixed(number, 2) : ""; }

// The measures of one manoeuvre, with the frequency of a swing; NaN for other manoeuvres.
struct PositionRow {
    std::string manoeuvre;
    double frequency_radps;
    const StringMeasures* measures;
};

// Returns the manoeuvres of a population. Of the swings, `all_swings` keeps all, else the worst one.
std::vector<PositionRow> rows_of(const StringResult& result, bool all_swings) {
    std::vector<PositionRow> rows;
    for (const SwingResult& swing : result.swings) {
        if (all_swings || &swing == result.worst_swing()) {
            rows.push_back({manoeuvre_name(Manoeuvre::Kind::swing), swing.frequency_radps, &swing.measures});
        }
    }
    for (const ManoeuvreResult& one : result.manoeuvres) {
        rows.push_back({manoeuvre_name(one.kind), kNan, &one.measures});
    }
    return rows;
}

}  // namespace

std::string string_summary_csv(const StringReport& report) {
    CsvWriter csv({"population", "manoeuvre", "frequency_radps", "vehicles", "lag_s", "gain", "gain_linear",
                   "linear_frequency_radps", "doubling_followers", "doubling_followers_linear", "stable_time_gap_s",
                   "first_growing_position", "holding_followers", "gap_error_m", "smallest_gap_m", "used_percent",
                   "jerk_mps3"});
    for (const StringResult& result : report.populations) {
        const SwingResult* const worst = result.worst_swing();
        for (const PositionRow& row : rows_of(result, false)) {
            const bool swings = !std::isnan(row.frequency_radps);
            const double gain = swings ? worst->measured.mean : kNan;
            const double linear = swings ? result.linear_peak.gain : kNan;
            const StringMeasures& m = *row.measures;
            csv.row({result.population, row.manoeuvre, fixed(row.frequency_radps, 4),
                     std::to_string(report.options.vehicles), fixed(swings ? result.follower_lag_s : kNan, 4),
                     fixed(gain, 5), fixed(linear, 5), fixed(swings ? result.linear_peak.frequency_radps : kNan, 4),
                     followers(swings ? doubling_followers(gain) : kNan),
                     followers(std::isnan(linear) ? kNan : doubling_followers(linear)),
                     fixed(swings ? result.stable_time_gap_s : kNan, 4),
                     m.first_growing_position > 0 ? std::to_string(m.first_growing_position) : "",
                     std::to_string(m.holding_followers), fixed(m.largest_gap_error_m, 4), fixed(m.smallest_gap_m, 4),
                     fixed(kPercent * m.largest_used_share, 2), fixed(m.largest_jerk_mps3, 3)});
        }
    }
    return csv.text();
}

std::string string_gains_csv(const StringReport& report) {
    CsvWriter csv({"population", "frequency_radps", "leader_amplitude_mps2", "gain", "gain_linear", "gain_first",
                   "gain_largest", "gap_error_m"});
    for (const StringResult& result : report.populations) {
        for (const SwingResult& swing : result.swings) {
            csv.row({result.population, fixed(swing.frequency_radps, 4), fixed(swing.leader_amplitude_mps2, 4),
                     fixed(swing.measured.mean, 5), fixed(swing.linear_gain, 5), fixed(swing.measured.first, 5),
                     fixed(swing.measured.largest, 5), fixed(swing.measures.largest_gap_error_m, 4)});
        }
    }
    return csv.text();
}

std::string string_positions_csv(const StringReport& report) {
    CsvWriter csv({"population", "manoeuvre", "frequency_radps", "position", "l2_mps2", "linf_mps2", "l2_ratio",
                   "linf_ratio", "l2_from_head", "linf_from_head", "gap_error_m", "smallest_gap_m", "used_percent",
                   "jerk_mps3"});
    for (const StringResult& result : report.populations) {
        for (const PositionRow& row : rows_of(result, true)) {
            for (std::size_t k = 0; k < row.measures->positions.size(); ++k) {
                const PositionMeasures& one = row.measures->positions[k];
                csv.row({result.population, row.manoeuvre, fixed(row.frequency_radps, 4), std::to_string(k),
                         fixed(one.l2_mps2, 4), fixed(one.linf_mps2, 4), fixed(one.l2_ratio, 4),
                         fixed(one.linf_ratio, 4), fixed(one.l2_from_head, 4), fixed(one.linf_from_head, 4),
                         fixed(one.gap_error_m, 4), fixed(one.smallest_gap_m, 4), fixed(kPercent * one.used_share, 2),
                         fixed(one.largest_jerk_mps3, 3)});
            }
        }
    }
    return csv.text();
}

std::string string_sweep_csv(const StringSweep& sweep) {
    CsvWriter csv({"population", "v2v_delay_s", "time_gap_s", "gain", "frequency_radps", "gain_linear",
                   "linear_frequency_radps"});
    for (const StringSweepPoint& one : sweep.points) {
        csv.row({sweep.population, fixed(one.v2v_delay_s, 3), fixed(one.time_gap_s, 3), fixed(one.measured_gain, 5),
                 fixed(one.measured_frequency_radps, 4), fixed(one.linear.gain, 5),
                 fixed(one.linear.frequency_radps, 4)});
    }
    return csv.text();
}

std::string string_border_csv(const StringSweep& sweep) {
    CsvWriter csv({"population", "v2v_delay_s", "stable_time_gap_s", "stable_time_gap_linear_s"});
    for (const StringBorder& one : sweep.border) {
        csv.row({sweep.population, fixed(one.v2v_delay_s, 3), fixed(one.measured_time_gap_s, 3),
                 fixed(one.linear_time_gap_s, 3)});
    }
    return csv.text();
}

}  // namespace stopline

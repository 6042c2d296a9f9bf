// Section V of the paper: the parameters of the mesoscale mode compared with Table 2 (rows C01 to C10 of
// data/paper/targets.csv), and the two criteria of the calibration (C11, C12). stopline-calibrate shows the details.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "calibration/band_check.h"
#include "calibration/calibration.h"
#include "paper/sections/scorecard_sections.h"
#include "paper/sections/scorecard_sweeps.h"
#include "scenario/load_scenario.h"
#include "sweeps/sweep_results.h"
#include "sweeps/sweep_run.h"

namespace stopline {

namespace {

constexpr const char* kParameters = "meso_parameters";
constexpr const char* kTimes = "calibration_times";
constexpr const char* kBands = "calibration_bands";

void set_model(Measurements& measured, const char* name, const KraussSettings& model) {
    measured.set(fmt::format("krauss_decel {}", name), model.deceleration_mps2);
    measured.set(fmt::format("krauss_accel {}", name), model.acceleration_mps2);
    measured.set(fmt::format("krauss_tau {}", name), model.reaction_s);
    measured.set(fmt::format("krauss_min_gap {}", name), model.standstill_gap_m);
    measured.set(fmt::format("krauss_sigma {}", name), model.dawdling);
}

Measurements measure_parameters(const Scenario& /*scenario*/, const ScorecardOptions& /*options*/) {
    const MesoSettings meso = load_meso(kCalibratedMeso);
    Measurements measured;
    set_model(measured, "CTG", meso.constant_time);
    set_model(measured, "CDG", meso.constant_distance);
    return measured;
}

Measurements measure_times(const Scenario& /*scenario*/, const ScorecardOptions& options) {
    const SweepRuns full =
        run_sweep(options, "calibration.yaml", {"fidelity=full"}, "times_full", detector_metrics, {0.0, 0.9});
    const MesoSettings meso = load_meso(kCalibratedMeso);
    const std::vector<CalibrationCase> cases = calibration_cases(full.sweep, full.store, meso);
    const TimingResult result = evaluate_timing(kCalibratedMeso, cases, meso, options.threads);
    const Agreement held_out = timing_agreement(result, cases, CaseSubset::held_out);
    Measurements measured;
    measured.set("held_out_within_percent", 100.0 * held_out.within_share);
    measured.set("held_out_median_s", held_out.median_s);
    measured.set("largest_s", timing_agreement(result, cases, CaseSubset::all).largest_s);
    const Violations& v = result.violations;
    measured.set("violations", static_cast<double>(v.overlaps + v.conflicts + v.red_entries + v.lost_vehicles) +
                                   static_cast<double>(full.totals.runs_with_violations));
    return measured;
}

Measurements measure_bands(const Scenario& /*scenario*/, const ScorecardOptions& options) {
    constexpr const char* kSweep = "intersection.yaml";
    const SweepRuns full = run_sweep(options, kSweep, {"fidelity=full"}, "bands_full", run_metrics, {0.0, 0.85});
    const SweepRuns meso = run_sweep(options, kSweep, {"fidelity=meso", std::string("meso=") + kCalibratedMeso},
                                     "bands_meso", run_metrics, {0.85, 1.0});
    const BandCheck check = check_bands(full.sweep, full.store, meso.store, band_metrics(full.sweep, {}));
    Measurements measured;
    for (const MetricBands& metric : check.metrics) {
        measured.set("inside " + metric.metric, 100.0 * metric.share_inside(Band::paper));
    }
    measured.set("all_paper_percent", 100.0 * check.share_inside(Band::paper));
    measured.set("all_student_percent", 100.0 * check.share_inside(Band::student));
    measured.set("violations",
                 static_cast<double>(full.totals.runs_with_violations + meso.totals.runs_with_violations));
    return measured;
}

std::optional<Answer> parameter(const Target& target, const Measurements& measured) {
    const std::optional<double> value = measured.find(target.quantity + " " + target.condition);
    return value ? std::optional(number_answer(*value)) : std::nullopt;
}

std::optional<Answer> largest_difference(const Target& /*target*/, const Measurements& measured) {
    const std::optional<double> largest_s = measured.find("largest_s");
    const std::optional<double> within = measured.find("held_out_within_percent");
    if (!largest_s || !within) return std::nullopt;
    Answer answer = number_answer(*largest_s);
    answer.text = fmt::format("{:.1f} ({:.1f} % within 1 s)", *largest_s, *within);
    return answer;
}

// The claim holds if throughput, density and travel time are inside their confidence bands in at least 95 % of the
// permutations, which are combinations of settings. The paper requires all permutations to be inside.
std::optional<Answer> inside_bands(const Target& /*target*/, const Measurements& measured) {
    const std::optional<double> paper = measured.find("all_paper_percent");
    if (!paper) return std::nullopt;
    std::string text = fmt::format("{:.1f} % all three", *paper);
    for (const auto& [name, value] : measured.values()) {
        if (name.starts_with("inside "))
            text += fmt::format(", {:.0f} % {}", value, name.substr(7, name.find('_') - 7));
    }
    return claim_answer(*paper >= 95.0, text);
}

}  // namespace

std::span<const Experiment> section5_experiments() {
    static const std::array kExperiments{Experiment{kParameters, "calibration", false, measure_parameters},
                                         Experiment{kTimes, "calibration", false, measure_times},
                                         Experiment{kBands, "intersection", false, measure_bands}};
    return kExperiments;
}

std::span<const RowJudge> section5_rows() {
    static const std::array kRows{RowJudge{"C01", kParameters, parameter},     RowJudge{"C02", kParameters, parameter},
                                  RowJudge{"C03", kParameters, parameter},     RowJudge{"C04", kParameters, parameter},
                                  RowJudge{"C05", kParameters, parameter},     RowJudge{"C06", kParameters, parameter},
                                  RowJudge{"C07", kParameters, parameter},     RowJudge{"C08", kParameters, parameter},
                                  RowJudge{"C09", kParameters, parameter},     RowJudge{"C10", kParameters, parameter},
                                  RowJudge{"C11", kTimes, largest_difference}, RowJudge{"C12", kBands, inside_bands}};
    return kRows;
}

}  // namespace stopline

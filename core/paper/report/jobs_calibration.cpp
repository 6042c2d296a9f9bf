// Jobs of Section V: comparison of the mesoscale mode with full dynamics. The mesoscale mode uses our calibrated
// parameters and, in a second comparison, the parameters of Table 2 of the paper (data/meso/table2.yaml). The
// parameters are not fitted again.
#include <fmt/format.h>

#include "base/io/csv.h"
#include "calibration/band_check.h"
#include "calibration/calibration.h"
#include "calibration/detector_times.h"
#include "figures/studies/calibration_figures.h"
#include "paper/report/job_writer.h"
#include "paper/report/jobs.h"
#include "scenario/load_scenario.h"

namespace stopline {

namespace {

std::string parameters_csv(const MesoSettings& paper, const MesoSettings& ours) {
    CsvWriter csv({"parameter", "unit", paper.name, ours.name});
    MesoSettings paper_copy = paper;  // FitParameter::value needs a mutable object
    MesoSettings our_copy = ours;
    for (const FitParameter& p : fit_parameters()) {
        csv.row({p.name, p.unit, fixed(p.value(paper_copy), 3), fixed(p.value(our_copy), 3)});
    }
    return csv.text();
}

}  // namespace

JobOutput run_calibration_times_job(const JobContext& context) {
    JobWriter writer(context);
    writer.experiment("meso_parameters");
    writer.experiment("calibration_times");
    // writer.experiment() has stored the runs with full dynamics, so run_sweep() only loads them.
    const SweepRuns full = run_sweep(context.scorecard(), "calibration.yaml", {"fidelity=full"}, "times_full",
                                     detector_metrics, {0.9, 1.0});
    const MesoSettings paper = load_meso("table2");
    const MesoSettings ours = load_meso(kCalibratedMeso);
    const std::vector<CalibrationCase> cases = calibration_cases(full.sweep, full.store, ours);
    const std::vector<TimingResult> results{evaluate_timing(paper.name, cases, paper, context.threads),
                                            evaluate_timing(ours.name, cases, ours, context.threads)};
    writer.conditions_of(full.sweep);
    writer.condition("Compared with",
                     std::string("the mesoscale mode with the parameters table2 and ") + kCalibratedMeso);
    writer.command(std::string("stopline-calibrate --step I --parameters ") + kCalibratedMeso);
    writer.table("parameters.csv", parameters_csv(paper, ours));
    writer.table("permutations.csv", permutations_csv(results, cases));
    writer.table("differences.csv", differences_csv(results.back(), cases));
    writer.table("misses.csv", misses_csv(timing_misses(results.back(), cases, {}), cases));
    writer.figures(timing_figures(results, cases, {}));
    return writer.output;
}

JobOutput run_calibration_bands_job(const JobContext& context) {
    JobWriter writer(context);
    writer.experiment("calibration_bands");
    // writer.experiment() has stored the runs of both sweeps, so the next two calls only load them.
    const SweepRuns full = intersection_runs(context.scorecard(), {1.0, 1.0});
    const SweepRuns meso =
        run_sweep(context.scorecard(), "intersection.yaml", {"fidelity=meso", std::string("meso=") + kCalibratedMeso},
                  "bands_meso", run_metrics, {1.0, 1.0});
    const BandCheck check = check_bands(full.sweep, full.store, meso.store, band_metrics(full.sweep, {}));
    writer.conditions_of(full.sweep);
    writer.condition("Compared with", std::string("the mesoscale mode with the parameters ") + kCalibratedMeso);
    writer.command(std::string("stopline-calibrate --step II --parameters ") + kCalibratedMeso);
    writer.table("bands_calibrated.csv", bands_csv(check));
    writer.figures(band_figures(check));
    return writer.output;
}

}  // namespace stopline

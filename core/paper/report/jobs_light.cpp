// Jobs of Sections III and IV: a single signal and a single intersection.
#include "base/io/data_directory.h"
#include "calibration/startup_report.h"
#include "figures/intersection_figures.h"
#include "figures/single_light_figures.h"
#include "figures/studies/startup_figure.h"
#include "figures/studies/turn_figures.h"
#include "paper/report/job_writer.h"
#include "paper/report/jobs.h"
#include "runs/intersection/intersection.h"
#include "runs/single_light/single_light.h"
#include "runs/single_light/single_light_csv.h"
#include "sweeps/seed_means.h"
#include "sweeps/sweep_results.h"

namespace stopline {

JobOutput run_startup_job(const JobContext& context) {
    constexpr const char* kMeasured = "startup/kit_curve_leader50.csv";
    JobWriter writer(context);
    const Scenario scenario = scenario_named(context, "single_light");
    const StartupReport report = report_startup(scenario, load_startup_curve(data_directory() / kMeasured));
    writer.conditions_of(scenario);
    writer.condition("Measured starts", std::string("data/") + kMeasured);
    writer.command("stopline-startup");
    writer.table("startup.csv", startup_csv(report));
    writer.figure(startup_figure(report));
    return writer.output;
}

JobOutput run_single_light_job(const JobContext& context) {
    JobWriter writer(context);
    writer.experiment("single_light_inputs");
    writer.experiment("single_light");
    const Scenario scenario = scenario_named(context, "single_light");
    SingleLightOptions options;
    options.threads = context.threads;
    options.on_progress = context.on_progress;
    const SingleLightReport result = run_single_light(scenario, options);
    writer.conditions_of(scenario);
    writer.command("stopline-run scenarios/single_light.yaml");
    writer.table("summary.csv", summary_csv(result));
    writer.table("improvement.csv", improvement_csv(result));
    writer.table("passages.csv", passages_csv(result));
    writer.figures(single_light_figures(result, load_targets()));
    return writer.output;
}

JobOutput run_intersection_job(const JobContext& context) {
    JobWriter writer(context);
    const Scenario scenario = scenario_named(context, "intersection");
    IntersectionOptions options;
    options.threads = context.threads;
    options.on_progress = context.on_progress;
    const IntersectionReport report = run_intersections(scenario, options);
    writer.conditions_of(scenario);
    writer.command("stopline-run scenarios/intersection.yaml");
    writer.table("summary.csv", intersection_csv(report));
    writer.table("headways.csv", headways_csv(report));
    writer.figures(intersection_figures(report));
    writer.output.violations = report.no_violations() ? 0 : 1;
    return writer.output;
}

JobOutput run_intersection_table_job(const JobContext& context) {
    JobWriter writer(context);
    writer.experiment("intersection");
    writer.conditions_of(scenario_named(context, "intersection"));
    writer.command("stopline-scorecard --section IV");
    return writer.output;
}

SweepRuns intersection_runs(const ScorecardOptions& options, ProgressRange range) {
    return run_sweep(options, "intersection.yaml", {"fidelity=full"}, "bands_full", run_metrics, range);
}

JobOutput run_intersection_sweep_job(const JobContext& context) {
    JobWriter writer(context);
    const SweepRuns runs = intersection_runs(context.scorecard(), {0.0, 1.0});
    const std::string csv = sweep_results(runs.store).csv;
    const CsvTable results = parse_csv(csv, "intersection.csv");
    writer.conditions_of(runs.sweep);
    writer.command("stopline-sweep scenarios/sweeps/intersection.yaml");
    writer.table("intersection.csv", csv);
    if (has_seeds(results)) {
        writer.table("intersection_means.csv",
                     seed_means_csv(results, runs.sweep.population_column(), runs.sweep.base().measure.baseline));
    }
    writer.table("table1.csv", table1_csv(results, load_targets()));
    writer.figures(turn_figures(results));
    writer.output.violations = static_cast<std::int64_t>(runs.totals.runs_with_violations);
    return writer.output;
}

}  // namespace stopline

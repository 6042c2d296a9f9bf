// Jobs of networks: arterial, grid, Berlin.
#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "figures/network_figures.h"
#include "figures/street_figures.h"
#include "figures/street_map.h"
#include "figures/studies/sweep_figures.h"
#include "figures/time_space_figure.h"
#include "paper/report/job_writer.h"
#include "paper/report/jobs.h"
#include "runs/network/network.h"
#include "runs/network/street_results.h"
#include "runs/parallel_runs.h"
#include "sweeps/seed_means.h"
#include "sweeps/sweep_results.h"

namespace stopline {

namespace {

// Runs a scorecard experiment that consists of one sweep. Writes the measurements, the table of the runs, and the
// figures.
JobOutput sweep_job(const JobContext& context, const char* experiment, const char* sweep) {
    JobWriter writer(context);
    writer.experiment(experiment);
    // writer.experiment() has stored the runs of this sweep, so run_sweep only loads them.
    const SweepRuns runs =
        run_sweep(context.scorecard(), (std::string(sweep) + ".yaml").c_str(), {}, experiment, run_metrics, {1.0, 1.0});
    const std::string csv = sweep_results(runs.store).csv;
    const CsvTable results = parse_csv(csv, sweep);
    writer.conditions_of(runs.sweep);
    writer.command(fmt::format("stopline-sweep scenarios/sweeps/{}.yaml", sweep));
    writer.table(fmt::format("{}.csv", sweep), csv);
    if (has_seeds(results)) {
        writer.table(fmt::format("{}_means.csv", sweep),
                     seed_means_csv(results, runs.sweep.population_column(), runs.sweep.base().measure.baseline));
    }
    if (is_network_sweep(results)) writer.figures(sweep_figures(results, runs.sweep.titles()));
    return writer.output;
}

NetworkReport network_report(const JobContext& context, const Scenario& scenario) {
    return run_networks(scenario, {context.threads, context.on_progress, {}});
}

// Returns a copy of the report with the named populations only.
NetworkReport with_populations(const NetworkReport& report, const std::vector<std::string>& names) {
    NetworkReport chosen = report;
    std::erase_if(chosen.populations, [&](const NetworkResult& f) {
        return std::find(names.begin(), names.end(), f.population) == names.end();
    });
    return chosen;
}

}  // namespace

JobOutput run_situations_job(const JobContext& context) {
    struct Situation {
        const char* name;
        std::vector<std::string> settings;
    };
    const std::vector<Situation> situations{
        {"situation_1", {"signal.green=10 s", "signal.cross_green=10 s"}},
        {"situation_2", {"signal.green=10 s", "signal.cross_green=10 s", "signal.offset=15 s"}},
        {"situation_3", {"signal.green=25 s", "signal.cross_green=10 s"}},
        {"situation_4", {"signal.green=35 s", "signal.cross_green=5 s"}}};
    const std::vector<std::string> shared{"demand.cross_left=0 %", "demand.cross_right=0 %", "populations=[CDG]",
                                          "measure.baseline=CDG"};
    const auto settings_of = [&](std::size_t k) {
        std::vector<std::string> settings = situations[k].settings;
        settings.insert(settings.end(), shared.begin(), shared.end());
        return settings;
    };
    std::vector<NetworkReport> reports(situations.size());
    run_side_by_side(
        situations.size(), context.threads, context.on_progress,
        [&](std::size_t k, const std::function<bool(double)>& report_progress) {
            reports[k] = run_networks(scenario_named(context, "arterial", settings_of(k)), {1, report_progress, {}});
        });
    JobWriter writer(context);
    for (std::size_t k = 0; k < situations.size(); ++k) {
        if (k == 0) writer.conditions_of(reports[k].scenario);
        std::string command = "stopline-run scenarios/arterial.yaml";
        for (const std::string& setting : settings_of(k)) command += fmt::format(" --set '{}'", setting);
        writer.command(command);
        writer.table(fmt::format("{}.csv", situations[k].name), network_csv(reports[k]));
        writer.figure(time_space_figure(reports[k]), situations[k].name);
        writer.output.violations += reports[k].no_violations() ? 0 : 1;
    }
    return writer.output;
}

JobOutput run_platoons_job(const JobContext& context) {
    JobWriter writer(context);
    writer.experiment("arterial_platoons");
    writer.conditions_of(scenario_named(context, "arterial"));
    writer.command("stopline-scorecard --section VI.B");
    return writer.output;
}

JobOutput run_arterial_job(const JobContext& context) { return sweep_job(context, "arterial", "arterial"); }
JobOutput run_grid_job(const JobContext& context) { return sweep_job(context, "grid", "grid"); }
JobOutput run_stability_job(const JobContext& context) { return sweep_job(context, "grid_stability", "stability"); }
JobOutput run_berlin_sweep_job(const JobContext& context) { return sweep_job(context, "berlin", "berlin"); }

JobOutput run_clearing_grid_job(const JobContext& context) {
    return sweep_job(context, "clearing_grid", "clearing_grid");
}
JobOutput run_coordination_berlin_job(const JobContext& context) {
    return sweep_job(context, "coordination_four_lanes", "coordination_four_lanes");
}
JobOutput run_energy_intersection_job(const JobContext& context) {
    return sweep_job(context, "energy_intersection", "energy_intersection");
}
JobOutput run_energy_grid_job(const JobContext& context) { return sweep_job(context, "energy_grid", "energy_grid"); }

JobOutput run_unstable_job(const JobContext& context) {
    JobWriter writer(context);
    // With these settings, the throughput of the grid is steady for some time and then falls.
    const std::vector<std::string> settings{"signal.green=20 s", "signal.offset=15 s", "demand.left=10 %",
                                            "demand.right=30 %"};
    const Scenario scenario = scenario_named(context, "grid", settings);
    const NetworkReport report = network_report(context, scenario);
    writer.conditions_of(scenario);
    std::string command = "stopline-run scenarios/grid.yaml";
    for (const std::string& setting : settings) command += fmt::format(" --set '{}'", setting);
    writer.command(command);
    writer.table("summary.csv", network_csv(report));
    writer.table("series.csv", network_series_csv(report));
    writer.figure(network_series_figure(report));
    writer.figure(delay_causes_figure(report));
    writer.output.violations = report.no_violations() ? 0 : 1;
    return writer.output;
}

JobOutput run_berlin_job(const JobContext& context) {
    JobWriter writer(context);
    const Scenario scenario = scenario_named(context, "berlin");
    const NetworkReport report = network_report(context, scenario);
    writer.conditions_of(scenario);
    writer.command("stopline-run scenarios/berlin.yaml");
    writer.table("summary.csv", network_csv(report));
    writer.table("series.csv", network_series_csv(report));
    writer.table("inflow.csv", inflow_csv(report));
    writer.table("approaches.csv", approaches_csv(report));
    writer.table("turns.csv", turns_csv(report));
    writer.figure(street_map(scenario));
    for (const auto& [folder, populations] :
         {std::pair{"fig26", std::vector<std::string>{"CTG-Ref", "CDG"}},
          std::pair{"fig25", std::vector<std::string>{"MIX", "SWITCH-1", "SWITCH-2"}}}) {
        const NetworkReport part = with_populations(report, populations);
        writer.figure(network_series_figure(part), folder);
        writer.figure(inflow_figure(part), folder);
        writer.figure(backlog_figure(part), folder);
    }
    writer.output.violations = report.no_violations() ? 0 : 1;
    return writer.output;
}

}  // namespace stopline

#include "paper/report/job_writer.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/io/data_directory.h"
#include "base/io/output.h"
#include "runs/interrupted.h"
#include "scenario/load_scenario.h"
#include "scenario/schema/quantity.h"

namespace stopline {

void JobWriter::table(const std::string& name, const std::string& csv) {
    write_file(context_.folder / name, csv);
    output.tables.push_back(name);
}

Figure marked_as_reduced(Figure figure) {
    // The mark is a gnuplot label with the tag 1000. gnuplot gives the other labels of a figure the tags 1, 2, ... The
    // tag of the mark must differ from them, because a label replaces an earlier label with the same tag.
    const std::string mark =
        "set label 1000 'REDUCED: quick run' at screen 0.992,0.02 left rotate by 90 noenhanced tc rgb '#b00000' font ',10' "
        "front\n";
    constexpr std::string_view kUnset = "unset label\n";  // between panels, figures remove all labels, also the mark
    for (std::size_t at = figure.body.find(kUnset); at != std::string::npos; at = figure.body.find(kUnset, at)) {
        at += kUnset.size();
        figure.body.insert(at, mark);
        at += mark.size();
    }
    figure.body.insert(0, mark);
    return figure;
}

void JobWriter::figure(Figure figure, const std::string& subfolder) {
    if (context_.on_progress && !context_.on_progress(1.0)) throw Interrupted();
    const std::filesystem::path folder = context_.folder / subfolder;
    prepare_folder(folder);
    const std::string name = figure.name;
    draw(context_.reduced() ? marked_as_reduced(std::move(figure)) : figure, folder);
    output.figures.push_back(subfolder.empty() ? name : subfolder + "/" + name);
}

void JobWriter::figures(std::vector<Figure> figures, const std::string& subfolder) {
    for (Figure& f : figures) figure(std::move(f), subfolder);
}

void JobWriter::experiment(const std::string& name) {
    const Experiment& experiment = experiment_named(name);
    const ScorecardOptions options = context_.scorecard();
    const Scenario scenario = scenario_of(experiment, options);
    const Measurements measured = experiment.measure(scenario, options);
    store_measurements(measured_file(context_.folder, name), context_.key, measured);
    output.measured.push_back(name);
    output.scenario_hashes[scenario.name] = scenario.hash;
    output.violations += static_cast<std::int64_t>(measured.find("violations").value_or(0.0));
}

void JobWriter::condition(const std::string& name, const std::string& text) {
    output.conditions.emplace_back(name, text);
}

void JobWriter::conditions_of(const Scenario& scenario) {
    const Unit& s = unit("s");
    condition("Scenario", fmt::format("{} ({}, {:016x})", scenario.title, scenario.name, scenario.hash));
    condition("Fidelity", scenario.is_meso()
                              ? fmt::format("mesoscale mode, parameters '{}', steps of {}", scenario.meso.name,
                                            short_text(scenario.tick_s(), unit("ms")))
                              : fmt::format("full dynamics, steps of {}", short_text(scenario.tick_s(), unit("ms"))));
    condition("Vehicle and driver", scenario.vehicle_name + ", " + scenario.driver_name);
    if (scenario.duration_s > 0.0) condition("Simulated time", short_text(scenario.duration_s, s));
    if (scenario.duration_s <= 0.0)
        condition("Simulated time", fmt::format("{} cycles measured", scenario.measure.cycles));
    std::vector<std::string> names;
    for (const PopulationSettings& population : scenario.populations) names.push_back(population.name);
    condition("Populations", fmt::format("{}", fmt::join(names, ", ")));
    output.seeds.insert(scenario.seed);
    output.scenario_hashes[scenario.name] = scenario.hash;
}

void JobWriter::conditions_of(const Sweep& sweep) {
    conditions_of(sweep.scenario(0));
    std::vector<std::string> axes;
    for (const SweepAxis& axis : sweep.settings().axes) {
        if (!axis.values.empty()) axes.push_back(fmt::format("{}: {}", axis.name, fmt::join(axis.values, ", ")));
    }
    condition("Combinations", fmt::format("{}", fmt::join(axes, "; ")));
    condition("Runs", fmt::format("{}", sweep.points()));
    for (int k = 0; k < sweep.settings().repetitions; ++k) {
        output.seeds.insert(sweep.base().seed + static_cast<std::uint64_t>(k));
    }
    output.scenario_hashes.erase(sweep.scenario(0).name);
    output.scenario_hashes[sweep.base().name] = sweep.base().hash;
}

void JobWriter::command(const std::string& text) {
    if (!context_.reduced()) output.commands.push_back(text);
}

Scenario scenario_named(const JobContext& context, const std::string& name, const std::vector<std::string>& settings) {
    std::vector<std::string> all = settings;
    const std::vector<std::string> reduced = context.reductions.settings("scenarios/" + name);
    all.insert(all.end(), reduced.begin(), reduced.end());
    return load_scenario(scenario_directory() / (name + ".yaml"), all);
}

std::string seeds_text(const std::set<std::uint64_t>& seeds) {
    if (seeds.empty()) return "none";
    const std::uint64_t first = *seeds.begin();
    const std::uint64_t last = *seeds.rbegin();
    if (seeds.size() == 1) return fmt::format("{}", first);
    if (last - first + 1 == seeds.size()) return fmt::format("{} to {}", first, last);
    return fmt::format("{}", fmt::join(seeds, ", "));
}

}  // namespace stopline

#include "paper/scorecard.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/input_error.h"
#include "base/io/csv.h"
#include "base/io/data_directory.h"
#include "base/io/output.h"
#include "paper/comparison_figure.h"
#include "paper/sections/scorecard_sections.h"
#include "runs/tables/column_aliases.h"
#include "scenario/load_scenario.h"

namespace stopline {

namespace {

template <class T>
std::vector<T> concatenated(std::initializer_list<std::span<const T>> parts) {
    std::vector<T> all;
    for (const std::span<const T> part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

const RowJudge* judge_of(const std::string& id) {
    const std::span<const RowJudge> all = row_judges();
    const auto found = std::find_if(all.begin(), all.end(), [&](const RowJudge& row) { return id == row.id; });
    return found == all.end() ? nullptr : &*found;
}

// Returns the targets of a section, or all targets if `section` is empty. Throws InputError for a section without rows.
std::vector<Target> targets_in_section(const std::string& section) {
    std::vector<Target> targets = load_targets();
    const std::vector<Target> own = load_own_rows();
    targets.insert(targets.end(), own.begin(), own.end());
    if (section.empty()) return targets;
    std::vector<std::string> known;
    for (const Target& target : targets) {
        if (std::find(known.begin(), known.end(), target.section) == known.end()) known.push_back(target.section);
    }
    std::erase_if(targets, [&](const Target& target) { return !in_section(target, section); });
    if (targets.empty()) {
        throw InputError(
            fmt::format("there are no rows of section '{}'; sections with rows: {}", section, fmt::join(known, ", ")));
    }
    return targets;
}

void send_message(const ScorecardOptions& options, const std::string& message) {
    if (options.on_message) options.on_message(message);
}

Measurements run_or_reuse(const Experiment& experiment, const Scenario& scenario, const ScorecardOptions& options) {
    if (!experiment.is_stored) return experiment.measure(scenario, options);
    const std::optional<std::string> key = results_key(scenario);
    const std::filesystem::path stored = options.folder / "measured" / (std::string(experiment.name) + ".csv");
    if (key) {
        if (const std::optional<Measurements> measured = load_measurements(stored, *key)) {
            send_message(options,
                         fmt::format("{}: already measured by this program, see {}", experiment.name, stored.string()));
            return *measured;
        }
    }
    send_message(options, fmt::format("{}: running", experiment.name));
    prepare_folder(stored.parent_path());
    Measurements measured = experiment.measure(scenario, options);
    if (key) store_measurements(stored, *key, measured);
    return measured;
}

// Runs the experiments that the targets need, or loads their stored measurements. Returns a map from experiment name to
// measurements. Adds the hash of each scenario to `scenario_hashes`.
std::map<std::string, Measurements> measure_for(const std::vector<Target>& targets, const ScorecardOptions& options,
                                                std::map<std::string, std::uint64_t>& scenario_hashes) {
    std::set<std::string> needed;
    for (const Target& target : targets) {
        if (const RowJudge* const row = judge_of(target.id)) needed.insert(row->experiment);
    }
    std::map<std::string, Measurements> measured;
    for (const Experiment& experiment : experiments()) {
        if (!needed.contains(experiment.name)) continue;
        const Scenario scenario = scenario_of(experiment, options);
        scenario_hashes[scenario.name] = scenario.hash;
        measured[experiment.name] = run_or_reuse(experiment, scenario, options);
    }
    return measured;
}

}  // namespace

// experiments() and row_judges() concatenate the lists of all sections. For a new section, add its lists to both
// functions.
std::span<const Experiment> experiments() {
    static const std::vector<Experiment> kAll = concatenated<Experiment>(
        {section3_experiments(), section4_experiments(), section5_experiments(), section6_experiments(),
         section7_experiments(), coordination_experiments(), energy_experiments()});
    return kAll;
}
std::span<const RowJudge> row_judges() {
    static const std::vector<RowJudge> kAll =
        concatenated<RowJudge>({section3_rows(), section4_rows(), section5_rows(), section6_rows(), section7_rows(),
                                coordination_rows(), energy_rows()});
    return kAll;
}

const Experiment& experiment_named(const std::string& name) {
    for (const Experiment& experiment : experiments()) {
        if (name == experiment.name) return experiment;
    }
    throw std::logic_error("no experiment is named " + name);
}

Scenario scenario_of(const Experiment& experiment, const ScorecardOptions& options) {
    std::vector<std::string> settings = options.reductions.settings(std::string("scenarios/") + experiment.scenario);
    settings.insert(settings.end(), options.settings.begin(), options.settings.end());
    const std::string file = std::string(experiment.scenario) + ".yaml";
    return load_scenario(scenario_directory() / file, settings);
}

std::vector<std::string> commands_behind(const std::vector<ScoredRow>& rows) {
    constexpr const char* kBerlin = "stopline-sweep scenarios/sweeps/berlin.yaml";
    constexpr std::array<std::array<const char*, 2>, 12> kCommands{{
        {"I", kBerlin},  // the introduction of the paper gives a gain for Berlin
        {"III", "stopline-run scenarios/single_light.yaml"},
        {"IV", "stopline-sweep scenarios/sweeps/intersection.yaml"},
        {"V", "stopline-calibrate"},
        {"VI.B", "stopline-sweep scenarios/sweeps/arterial.yaml"},
        {"VI.C", "stopline-sweep scenarios/sweeps/grid.yaml"},
        {"VI.D", "stopline-sweep scenarios/sweeps/stability.yaml"},
        {"VII", kBerlin},
        {"coordination", "stopline-sweep scenarios/sweeps/clearing_grid.yaml"},
        {"coordination", "stopline-sweep scenarios/sweeps/coordination_four_lanes.yaml"},
        {"energy", "stopline-sweep scenarios/sweeps/energy_intersection.yaml"},
        {"energy", "stopline-sweep scenarios/sweeps/energy_grid.yaml"},
    }};
    std::vector<std::string> commands;
    for (const auto& [section, command] : kCommands) {
        const std::string name = section;
        const bool shown =
            std::any_of(rows.begin(), rows.end(), [&](const ScoredRow& row) { return in_section(row.target, name); });
        const bool listed = std::find(commands.begin(), commands.end(), command) != commands.end();
        if (shown && !listed) commands.emplace_back(command);
    }
    return commands;
}

int Scorecard::count(Verdict verdict) const {
    return static_cast<int>(
        std::count_if(rows.begin(), rows.end(), [&](const ScoredRow& row) { return row.verdict == verdict; }));
}

Scorecard make_scorecard(const ScorecardOptions& options) {
    std::map<std::string, std::uint64_t> hashes;
    const std::map<std::string, Measurements> measured =
        measure_for(targets_in_section(options.section), options, hashes);
    Scorecard scorecard = score(options.section, measured);
    scorecard.scenario_hashes = std::move(hashes);
    return scorecard;
}

Scorecard score(const std::string& section, const std::map<std::string, Measurements>& measured) {
    Scorecard scorecard;
    const std::map<std::string, Explanation> explanations =
        load_explanations(data_directory() / "paper" / "explanations.csv", scorecard.warnings);
    for (const Target& target : targets_in_section(section)) {
        ScoredRow row{target, "", judge(target, std::nullopt), "", ""};
        const RowJudge* const judge_row = judge_of(target.id);
        const auto found = judge_row == nullptr ? measured.end() : measured.find(judge_row->experiment);
        if (found != measured.end()) {
            const std::optional<Answer> answer = judge_row->answer(target, found->second);
            row.verdict = judge(target, answer);
            if (answer) row.ours = answer->text;
        }
        explain(explanations, row);
        scorecard.rows.push_back(std::move(row));
    }
    scorecard.figures = comparison_figure(measured);
    for (const auto& [name, measurements] : measured) {
        scorecard.violations += measurements.find("violations").value_or(0.0);
    }
    return scorecard;
}

std::string explanation_text(const ScoredRow& row) {
    const std::string between = row.measured_as.empty() || row.explanation.empty() ? "" : " ";
    return row.measured_as + between + row.explanation;
}

std::string scorecard_csv(const Scorecard& scorecard) {
    CsvWriter csv({"id", "section", "paper", "ours", "unit", "tolerance", "verdict", "explanation"});
    for (const ScoredRow& row : scorecard.rows) {
        csv.row({row.target.id, row.target.section, row.target.value, row.ours, row.target.unit,
                 tolerance_text(row.target), to_string(row.verdict), explanation_text(row)});
    }
    return csv.text();
}

std::map<std::string, Explanation> load_explanations(const std::filesystem::path& file,
                                                     std::vector<std::string>& warnings) {
    CsvTable table = parse_csv(read_file(file), file.string());
    warnings = use_current_column_names("data/paper/explanations.csv", table);
    const std::size_t id = table.column("id");
    const std::size_t measured_as = table.column("measured_as");
    const std::size_t explanation = table.column("explanation");
    std::map<std::string, Explanation> explanations;
    for (const std::vector<std::string>& row : table.rows) explanations[row[id]] = {row[measured_as], row[explanation]};
    return explanations;
}

void explain(const std::map<std::string, Explanation>& explanations, ScoredRow& row) {
    const auto found = explanations.find(row.target.id);
    if (found != explanations.end()) row.measured_as = found->second.measured_as;
    if (row.verdict != Verdict::miss) return;
    if (found != explanations.end()) row.explanation = found->second.explanation;
    if (row.explanation.empty()) row.explanation = "Not explained yet.";
}

}  // namespace stopline

#include "experiment/scorecard.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/input_error.h"
#include "experiment/comparison_figure.h"
#include "experiment/csv.h"
#include "experiment/output.h"
#include "experiment/scorecard_sections.h"
#include "scenario/load_scenario.h"

namespace stopline {

namespace {

template <class T>
std::vector<T> joined(std::initializer_list<std::span<const T>> parts) {
    std::vector<T> all;
    for (const std::span<const T> part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

const RowJudge* judge_of(const std::string& id) {
    const std::span<const RowJudge> all = row_judges();
    const auto found = std::find_if(all.begin(), all.end(), [&](const RowJudge& row) { return id == row.id; });
    return found == all.end() ? nullptr : &*found;
}

std::vector<Target> chosen_targets(const std::string& section) {
    std::vector<Target> targets = load_targets();
    if (section.empty()) return targets;
    std::vector<std::string> known;
    for (const Target& target : targets) {
        if (std::find(known.begin(), known.end(), target.section) == known.end()) known.push_back(target.section);
    }
    std::erase_if(targets, [&](const Target& target) { return !in_section(target, section); });
    if (targets.empty()) {
        throw InputError(
            fmt::format("there are no rows of section '{}'; known are: {}", section, fmt::join(known, ", ")));
    }
    return targets;
}

void tell(const ScorecardOptions& options, const std::string& message) {
    if (options.on_message) options.on_message(message);
}

Measurements run_or_reuse(const Experiment& experiment, const Scenario& scenario, const ScorecardOptions& options) {
    if (!experiment.runs) return experiment.measure(scenario, options);
    const std::optional<std::string> key = results_key(scenario);
    const std::filesystem::path stored = options.folder / "measured" / (std::string(experiment.name) + ".csv");
    if (key) {
        if (const std::optional<Measurements> measured = load_measurements(stored, *key)) {
            tell(options, fmt::format("{}: measured before by this program, see {}", experiment.name, stored.string()));
            return *measured;
        }
    }
    tell(options, fmt::format("{}: running", experiment.name));
    prepare_folder(stored.parent_path());
    Measurements measured = experiment.measure(scenario, options);
    if (key) store_measurements(stored, *key, measured);
    return measured;
}

// By experiment, those that the rows need.
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

// One line a section.
std::span<const Experiment> experiments() {
    static const std::vector<Experiment> kAll =
        joined<Experiment>({section3_experiments(), section4_experiments(), section5_experiments(),
                            section6_experiments(), section7_experiments()});
    return kAll;
}
std::span<const RowJudge> row_judges() {
    static const std::vector<RowJudge> kAll =
        joined<RowJudge>({section3_rows(), section4_rows(), section5_rows(), section6_rows(), section7_rows()});
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
    return load_scenario(data_directory().parent_path() / "scenarios" / file, settings);
}

std::vector<std::string> commands_behind(const std::vector<ScoredRow>& rows) {
    constexpr const char* kBerlin = "stopline-sweep scenarios/sweeps/berlin.yaml";
    constexpr std::array<std::array<const char*, 2>, 8> kCommands{{
        {"I", kBerlin},  // the gain that the paper's introduction names
        {"III", "stopline-run scenarios/single_light.yaml"},
        {"IV", "stopline-sweep scenarios/sweeps/intersection.yaml"},
        {"V", "stopline-calibrate"},
        {"VI.B", "stopline-sweep scenarios/sweeps/arterial.yaml"},
        {"VI.C", "stopline-sweep scenarios/sweeps/grid.yaml"},
        {"VI.D", "stopline-sweep scenarios/sweeps/stability.yaml"},
        {"VII", kBerlin},
    }};
    std::vector<std::string> commands;
    for (const auto& [section, command] : kCommands) {
        const std::string of = section;
        const bool shown =
            std::any_of(rows.begin(), rows.end(), [&](const ScoredRow& row) { return in_section(row.target, of); });
        const bool named = std::find(commands.begin(), commands.end(), command) != commands.end();
        if (shown && !named) commands.emplace_back(command);
    }
    return commands;
}

int Scorecard::count(Verdict verdict) const {
    return static_cast<int>(
        std::count_if(rows.begin(), rows.end(), [&](const ScoredRow& row) { return row.verdict == verdict; }));
}

Scorecard make_scorecard(const ScorecardOptions& options) {
    std::map<std::string, std::uint64_t> hashes;
    const std::map<std::string, Measurements> measured = measure_for(chosen_targets(options.section), options, hashes);
    Scorecard scorecard = score(options.section, measured);
    scorecard.scenario_hashes = std::move(hashes);
    return scorecard;
}

Scorecard score(const std::string& section, const std::map<std::string, Measurements>& measured) {
    const std::map<std::string, Explanation> explanations =
        load_explanations(data_directory() / "paper" / "explanations.csv");
    Scorecard scorecard;
    for (const Target& target : chosen_targets(section)) {
        ScoredRow row{target, "", Verdict::open, "", ""};
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

std::string scorecard_csv(const Scorecard& scorecard) {
    CsvWriter csv({"id", "section", "paper", "ours", "unit", "tolerance", "verdict", "explanation"});
    for (const ScoredRow& row : scorecard.rows) {
        const std::string between = row.counted.empty() || row.reason.empty() ? "" : "; ";
        csv.row({row.target.id, row.target.section, row.target.value, row.ours, row.target.unit,
                 tolerance_text(row.target), to_string(row.verdict), row.counted + between + row.reason});
    }
    return csv.text();
}

std::map<std::string, Explanation> load_explanations(const std::filesystem::path& file) {
    const CsvTable table = parse_csv(read_file(file), file.string());
    const std::size_t id = table.column("id");
    const std::size_t counted = table.column("counted");
    const std::size_t reason = table.column("explanation");
    std::map<std::string, Explanation> explanations;
    for (const std::vector<std::string>& row : table.rows) explanations[row[id]] = {row[counted], row[reason]};
    return explanations;
}

void explain(const std::map<std::string, Explanation>& explanations, ScoredRow& row) {
    const auto found = explanations.find(row.target.id);
    if (found != explanations.end()) row.counted = found->second.counted;
    if (row.verdict != Verdict::miss) return;
    if (found != explanations.end()) row.reason = found->second.reason;
    if (row.reason.empty()) row.reason = "not explained yet";
}

}  // namespace stopline

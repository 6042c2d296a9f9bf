#include "common/command_line.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/input_error.h"
#include "base/io/console.h"
#include "base/nearest_name.h"
#include "common/examples.h"
#include "common/text_table.h"
#include "runs/metrics/metric_groups.h"
#include "scenario/files/scenario_files.h"
#include "scenario/fleets.h"
#include "scenario/kinds/network_kind.h"
#include "scenario/load_scenario.h"
#include "scenario/schema/quantity.h"
#include "sim/state/model.h"  // the list of spacing laws and of signal controllers

namespace stopline {

std::string shell_word(const std::string& text) {
    constexpr const char* kSafe = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+%@";
    if (!text.empty() && text.find_first_not_of(kSafe) == std::string::npos) return text;
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

namespace {

std::string shares_text(const PopulationSettings& population) {
    std::vector<std::string> parts;
    for (const PopulationSettings::Component& component : population.components) {
        parts.push_back(fmt::format("{:.4g} % {}", 100.0 * component.share, component_name(component)));
    }
    return fmt::format("{}", fmt::join(parts, ", "));
}

void append_names(std::string& text, const std::string& heading, const std::string& folder) {
    text += fmt::format("\n{}\n", heading);
    for (const std::string& name : data_names(folder)) text += fmt::format("  {}\n", name);
}

// Appends the metrics of some kinds of networks. A null `scenario` gives those of all scenarios.
void append_metrics(std::string& text, const MetricGroup& group, const Scenario* scenario) {
    constexpr std::size_t kIndent = 4;
    text += fmt::format("\nMetrics of {}, in summary.csv and in sweeps (details: scenarios/COLUMNS.md)\n", group.title);
    for (const ListedMetric& metric : group.list(scenario)) {
        const std::string unit = metric.unit.empty() ? "" : fmt::format(" [{}]", metric.unit);
        text += wrap_text(fmt::format("  {}{}: {}", metric.column, unit, metric.meaning), kConsoleWidth, kIndent);
    }
}

}  // namespace

void add_common_options(Options& app, CommonOptions& options, const std::string& output_help) {
    app.add("--threads", options.threads, "Number of threads (default: all processors). Results do not depend on it")
        .range(1, 1024)
        .type_name("N");
    app.add("--seed", options.seed, "Seed of all random numbers (default: the scenario's)");
    app.add("--output", options.output, output_help).type_name("DIR");
}

void add_set_option(Options& app, CommonOptions& options) {
    app.add("--set", options.settings,
            runnable("Set a field of the scenario, such as 'signal.green=20 s' (repeatable). "
                     "stopline-run --describe lists all fields"))
        .type_name("PATH=VALUE")
        .one_value_each();
}

void add_old_column_names_option(Options& app, CommonOptions& options) {
    app.add_flag("--old-column-names", options.old_column_names,
                 "Write tables with the column and file names of the last release (removed in the next release)");
}

ColumnNames column_names(const CommonOptions& options) {
    if (!options.old_column_names) return ColumnNames::current;
    print_warnings({kOldNamesWarning});
    return ColumnNames::old;
}

void print_warnings(const std::vector<std::string>& warnings) {
    static std::set<std::string> printed;
    for (const std::string& warning : warnings) {
        if (printed.insert(warning).second) print_message("warning: {}\n", warning);
    }
}

Scenario load_with_options(const std::string& file, const CommonOptions& options) {
    std::vector<std::string> settings = options.settings;
    if (options.seed && std::any_of(settings.begin(), settings.end(),
                                    [](const std::string& text) { return text.starts_with("seed="); })) {
        throw InputError("--seed and --set 'seed=...' both set the seed; give one of them");
    }
    if (options.seed) settings.push_back(fmt::format("seed={}", *options.seed));
    Scenario scenario = load_scenario(file, settings);
    print_warnings(scenario.warnings);
    return scenario;
}

void add_scenario_inputs(CommandFiles& files, const std::string& file, const CommonOptions& options) {
    for (const std::filesystem::path& input : scenario_files(file, options.settings)) {
        files.add_input(input, input == file ? "the scenario" : "a file that the scenario names");
    }
}

void add_sweep_inputs(CommandFiles& files, const std::string& sweep_file, const SweepSettings& sweep,
                      const std::vector<std::string>& overrides) {
    files.add_input(sweep_file, "the sweep file");
    CommonOptions options;
    options.settings = overrides;
    add_scenario_inputs(files, sweep.scenario, options);
    const std::filesystem::path directory = std::filesystem::path(sweep.scenario).parent_path();
    for (const SweepAxis& axis : sweep.axes) {
        for (const std::string& value : axis.values) {
            std::error_code ignored;
            const std::filesystem::path file = directory / value;
            if (std::filesystem::is_regular_file(file, ignored)) files.add_input(file, "the axis " + axis.name);
        }
    }
}

std::string settings_hint(const std::string& file, const CommonOptions& options, const std::string& purpose,
                          const std::vector<std::string>& settings) {
    const auto is_accepted = [&](const std::string& setting) {
        if (std::find(options.settings.begin(), options.settings.end(), setting) != options.settings.end())
            return false;
        std::vector<std::string> all = options.settings;
        all.push_back(setting);
        try {
            load_scenario(file, all);
        } catch (const InputError&) {
            return false;
        }
        return true;
    };
    std::string line;
    for (const std::string& setting : settings) {
        if (is_accepted(setting)) line += " --set " + shell_word(setting);
    }
    return line.empty() ? "" : fmt::format("  {}: add{}\n", purpose, line);
}

void set_mesoscale(const char* program, CommonOptions& options) {
    const std::string mesoscale = "fidelity=meso";
    std::erase_if(options.settings, [&](const std::string& setting) {
        if (!setting.starts_with("fidelity=")) return false;
        if (setting != mesoscale)
            print_message("{}: '{}' is not used: this program runs the mesoscale mode only\n", program, setting);
        return true;
    });
    options.settings.push_back(mesoscale);
}

std::string command_text(const std::string& program, const std::string& file, const CommonOptions& options) {
    std::string text = program;
    if (!file.empty()) text += " " + shell_word(file);
    if (options.seed) text += fmt::format(" --seed {}", *options.seed);
    for (const std::string& setting : options.settings) text += " --set " + shell_word(setting);
    return text;
}

std::string list_text(const std::string& file, const CommonOptions& options) {
    const bool has_file = !file.empty();
    const Scenario scenario = has_file ? load_with_options(file, options) : Scenario{};
    std::string text = has_file ? fmt::format("Spacing policies that {} can use\n", file)
                                : "Spacing policies (data/policies/paper.yaml); a scenario can define more\n";
    for (const GapPolicySettings& policy : has_file ? scenario.policies : load_policies()) {
        text += fmt::format("  {:<14} {:<18} net gap {:.4g} m at rest, {:.4g} m at 50 km/h\n", policy.name, policy.law,
                            equilibrium_gap_m(policy, 0.0), equilibrium_gap_m(policy, 50.0 / 3.6));
    }
    text += "\nSpacing laws, for policies of your own\n";
    for (const GapLaw* law : gap_laws()) text += fmt::format("  {:<18} {}\n", law->name, law->meaning);
    if (has_file) {
        text += fmt::format("\nPopulations of {}, with one run each\n", file);
        for (const PopulationSettings& population : scenario.populations) {
            text += fmt::format("  {:<14} {}\n", population.name, shares_text(population));
        }
    } else {
        text += "\nPopulations: each policy is also the name of a population of its vehicles alone.\n";
        text += runnable("A scenario can define mixed populations, see scenarios/single_light.yaml\n");
    }
    text += "\nKinds of networks (network.kind)\n";
    for (const NetworkKind* kind : network_kinds()) text += fmt::format("  {:<18} {}\n", kind->name, kind->meaning);
    text += "\nSignal controllers (signal.controller)\n";
    for (const SignalController* controller : signal_controllers()) {
        text += fmt::format("  {:<18} {}\n", controller->name, controller->meaning);
    }
    append_names(text, "Vehicles (data/vehicles)", "vehicles");
    append_names(text, "Drivers (data/drivers)", "drivers");
    append_names(text, "Streets (data/berlin)", "berlin");
    if (has_file) {
        append_metrics(text, metric_group_of(scenario.network), &scenario);
    } else {
        for (const MetricGroup& group : metric_groups()) append_metrics(text, group, nullptr);
    }
    return text;
}

void add_population_option(Options& app, std::vector<std::string>& names, const std::string& default_text) {
    app.add("--population", names,
            fmt::format("Population of the scenario, or policy of all vehicles; may be repeated (default: {})",
                        default_text))
        .type_name("NAME")
        .one_value_each();
}

void choose_populations(const std::vector<std::string>& names, Scenario& scenario) {
    if (names.empty()) return;
    std::vector<PopulationSettings> chosen;
    std::vector<std::string> known;
    for (const PopulationSettings& population : scenario.populations) known.push_back(population.name);
    for (const GapPolicySettings& policy : scenario.policies) {
        if (std::find(known.begin(), known.end(), policy.name) == known.end()) known.push_back(policy.name);
    }
    for (const std::string& name : names) {
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            throw InputError(fmt::format("--population: there is no population or policy '{}'{}", shortened(name),
                                         known_names_hint(name, known)));
        }
        const auto population = std::find_if(scenario.populations.begin(), scenario.populations.end(),
                                             [&](const PopulationSettings& one) { return one.name == name; });
        chosen.push_back(population != scenario.populations.end()
                             ? *population
                             : PopulationSettings{name, {{name, 1.0}}, PopulationSettings::Pattern::alternating});
    }
    scenario.populations = std::move(chosen);
    scenario.measure.baseline.clear();
    scenario.hash = scenario_hash(scenario);
}

}  // namespace stopline

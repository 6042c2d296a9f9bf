#include "common/command_line.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/version.h"
#include "scenario/load_scenario.h"
#include "scenario/quantity.h"
#include "sim/model.h"  // the registry of spacing laws

namespace stopline {

std::string shell_word(const std::string& text) {
    constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+%@";
    if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

namespace {

std::uint64_t seed_from(const std::string& text) {
    const ParsedWhole seed = parse_whole(text);
    if (!seed.problem.empty()) throw CLI::ValidationError("--seed", fmt::format("value '{}' {}", text, seed.problem));
    return seed.value;
}

std::string shares_text(const PopulationSettings& population) {
    std::vector<std::string> parts;
    for (const PopulationSettings::Component& component : population.components) {
        parts.push_back(fmt::format("{:.4g} % {}", 100.0 * component.share, component.policy));
    }
    return fmt::format("{}", fmt::join(parts, ", "));
}

void append_names(std::string& text, const std::string& heading, const std::string& folder) {
    text += fmt::format("\n{}\n", heading);
    for (const std::string& name : data_names(folder)) text += fmt::format("  {}\n", name);
}

}  // namespace

void add_version_option(CLI::App& app) {
    app.get_formatter()->column_width(34);
    app.set_version_flag("--version", std::string("stopline ") + version(), "Print the version and exit");
}

void add_common_options(CLI::App& app, CommonOptions& options, const std::string& output_help) {
    add_version_option(app);
    app.add_option("--threads", options.threads, "Threads to use (default: all); results do not depend on it")
        ->check(CLI::Range(1, 1024))
        ->type_name("N");
    // As text: CLI11 takes -1 and numbers that are too large for whole numbers.
    app.add_option_function<std::string>(
           "--seed", [&options](const std::string& text) { options.seed = seed_from(text); },
           "Seed of all random numbers, instead of the scenario's")
        ->type_name("S");
    app.add_option("--output", options.output, output_help)->type_name("DIR");
}

void add_set_option(CLI::App& app, CommonOptions& options) {
    app.add_option("--set", options.settings, "Set a field of the scenario (repeatable); --describe lists all fields")
        ->type_name("PATH=VALUE")
        ->allow_extra_args(false);
}

std::optional<ExitCode> parse_command_line(CLI::App& app, int argc, const char* const* argv) {
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {
        app.exit(success);  // prints the help or the version
        return ExitCode::done;
    } catch (const CLI::ParseError& error) {
        fmt::print(stderr, "{}: {}\nTry {} --help\n", app.get_name(), error.what(), app.get_name());
        return ExitCode::bad_input;
    }
    return std::nullopt;
}

Scenario load_with_options(const std::string& file, const CommonOptions& options) {
    std::vector<std::string> settings = options.settings;
    if (options.seed) settings.push_back(fmt::format("seed={}", *options.seed));
    return load_scenario(file, settings);
}

void set_mesoscale(const char* program, CommonOptions& options) {
    const std::string mesoscale = "fidelity=meso";
    for (const std::string& setting : options.settings) {
        if (!setting.starts_with("fidelity=") || setting == mesoscale) continue;
        fmt::print(stderr, "{}: '{}' is not used: this program runs the mesoscale mode\n", program, setting);
    }
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
    const bool given = !file.empty();
    const Scenario scenario = given ? load_with_options(file, options) : Scenario{};
    std::string text = given ? fmt::format("Spacing policies that {} can use\n", file)
                             : "Spacing policies of data/policies/paper.yaml (a scenario can add its own)\n";
    for (const GapPolicySettings& policy : given ? scenario.policies : load_policies()) {
        text += fmt::format("  {:<14} {:<18} {:.4g} m at rest, {:.4g} m at 50 km/h\n", policy.name, policy.law,
                            equilibrium_gap_m(policy, 0.0), equilibrium_gap_m(policy, 50.0 / 3.6));
    }
    text += "\nSpacing laws, for own policies\n";
    for (const GapLaw& law : gap_laws()) text += fmt::format("  {:<18} {}\n", law.name, law.meaning);
    if (given) {
        text += fmt::format("\nPopulations of {}, one run each\n", file);
        for (const PopulationSettings& population : scenario.populations) {
            text += fmt::format("  {:<14} {}\n", population.name, shares_text(population));
        }
    } else {
        text +=
            "\nPopulations: every policy is one by its name; a scenario can mix several (see scenarios/single_light.yaml)\n";
    }
    append_names(text, "Vehicles (data/vehicles)", "vehicles");
    append_names(text, "Drivers (data/drivers)", "drivers");
    append_names(text, "Streets (data/berlin)", "berlin");
    return text;
}

}  // namespace stopline

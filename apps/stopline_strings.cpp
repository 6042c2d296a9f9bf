// stopline-strings: drives platoons behind a leader that swings, brakes hard, or starts from rest. Compares the
// measured string stability with the linear analysis.
#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/command_files.h"
#include "base/io/data_directory.h"
#include "base/io/output.h"
#include "base/state_hash.h"
#include "base/units.h"
#include "common/command_line.h"
#include "common/examples.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "common/results.h"
#include "figures/string_figures.h"
#include "runs/provenance.h"
#include "runs/strings/string_csv.h"
#include "runs/strings/string_report.h"
#include "runs/strings/string_sweep.h"
#include "scenario/schema/quantity.h"
#include "strings/string_text.h"

namespace stopline {

namespace {

constexpr const char* kAllManoeuvres = "all";
constexpr const char* kDefaultDelays = "20 ms, 60 ms, 100 ms, 150 ms, 200 ms, 300 ms";
constexpr const char* kDefaultTimeGaps = "0.2 s, 0.3 s, 0.4 s, 0.5 s, 0.6 s, 0.7 s, 0.8 s, 1 s, 1.2 s, 1.4 s";

struct StringsCliOptions {
    CommonOptions common;
    std::string file;
    std::vector<std::string> populations;
    int vehicles = 20;
    std::string manoeuvre = kAllManoeuvres;
    std::string speed;
    std::string amplitude = "0.3 m/s2";
    std::string deceleration = "6 m/s2";
    std::vector<std::string> frequencies;
    bool sweep = false;
    std::string delays;     // empty: kDefaultDelays
    std::string time_gaps;  // empty: kDefaultTimeGaps
    bool no_figures = false;
};

void declare(Options& app, StringsCliOptions& options) {
    app.add("FILE", options.file,
            runnable("Scenario with a straight road (default: scenarios/single_light.yaml). Each of its populations "
                     "drives as a platoon"));
    add_population_option(app, options.populations, "all populations");
    app.add("--vehicles", options.vehicles, "Number of vehicles of a platoon, with its leader")
        .range(2, 200)
        .show_default();
    app.add("--manoeuvre", options.manoeuvre, "Manoeuvre of the platoon leader")
        .one_of({kAllManoeuvres, "swing", "brake", "start"})
        .show_default();
    app.add("--speed", options.speed,
            "Speed before braking, and mean speed of swings (default: 70 % of the speed limit)")
        .type_name("SPEED");
    app.add("--amplitude", options.amplitude, "Amplitude of the acceleration of swings; slow and fast swings have less")
        .type_name("ACCELERATION")
        .show_default();
    app.add(
           "--frequency", options.frequencies,
           "Angular frequency of a swing, a number in rad/s; may be repeated (default: 18 from 0.15 to 8, or 12 from 0.25 to 1.6 with --sweep)")
        .type_name("NUMBER")
        .one_value_each();
    app.add("--deceleration", options.deceleration, "Deceleration of the hard braking")
        .type_name("ACCELERATION")
        .show_default();
    app.add_flag(
        "--sweep", options.sweep,
        "Vary the V2V delay and the time gap of the first population, and find the border of string stability");
    app.add("--delays", options.delays, fmt::format("With --sweep: V2V delays (default: {})", kDefaultDelays))
        .only_with({"--sweep"})
        .type_name("LIST");
    app.add("--time-gaps", options.time_gaps, fmt::format("With --sweep: time gaps (default: {})", kDefaultTimeGaps))
        .only_with({"--sweep"})
        .type_name("LIST");
    app.add_flag("--no-figures", options.no_figures, "Do not draw figures");
    add_common_options(app, options.common, "Folder for the results (default: out/strings)");
    add_set_option(app, options.common);
    app.footer(runnable("\nExamples:\n"
                        "  stopline-strings --population CDG --population CTG-Ref\n"
                        "  stopline-strings --population CDG --set 'driver.cacc.v2v_delay=150 ms'\n"
                        "  stopline-strings --manoeuvre brake --vehicles 40 --speed '50 km/h'\n"
                        "  stopline-strings --sweep --population CTG-Ref --output out/border\n\n"
                        "Next: see the effect of the delay on the throughput of a light\n"
                        "  stopline-run scenarios/single_light.yaml --set 'driver.cacc.v2v_delay=150 ms'\n\n") +
               kExitCodesText);
}

// Returns a quantity from the command line in SI units. Throws InputError unless it is from `low` to `high`.
double quantity(const std::string& option, const std::string& text, const char* in, double low, double high) {
    const Unit& expected = unit(in);
    const ParsedQuantity parsed = parse_quantity(text, expected);
    if (!parsed.problem.empty()) throw InputError(fmt::format("{}: value '{}' {}", option, text, parsed.problem));
    if (parsed.si < to_si(low, expected) || parsed.si > to_si(high, expected)) {
        const std::string with_unit = *in == 0 ? "" : std::string(" ") + in;
        throw InputError(fmt::format("{}: value '{}' is not allowed; allowed: {:g}{} to {:g}{}", option, text, low,
                                     with_unit, high, with_unit));
    }
    return parsed.si;
}

// Returns a list of quantities, separated by commas, in ascending order. Each value may occur only once.
std::vector<double> quantities(const std::string& option, const std::string& text, const char* in, double low,
                               double high) {
    std::vector<double> values;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        std::string one = text.substr(begin, end - begin);
        one.erase(0, one.find_first_not_of(' '));
        values.push_back(quantity(option, one, in, low, high));
        begin = end + 1;
    }
    std::sort(values.begin(), values.end());
    if (std::adjacent_find(values.begin(), values.end()) != values.end()) {
        throw InputError(fmt::format("{}: '{}' has a value twice; give each value once", option, text));
    }
    return values;
}

StringOptions string_options(const StringsCliOptions& options, const Scenario& scenario) {
    StringOptions strings;
    strings.threads = thread_count(options.common.threads);
    strings.vehicles = options.vehicles;
    const double limit_kmh = scenario.network.approach.speed_limit_mps * kKmhPerMps;
    strings.speed_mps = options.speed.empty() ? default_string_speed_mps(scenario)
                                              : quantity("--speed", options.speed, "km/h", 5.0, limit_kmh);
    strings.amplitude_mps2 = quantity("--amplitude", options.amplitude, "m/s2", 0.01, 3.0);
    strings.deceleration_mps2 = quantity("--deceleration", options.deceleration, "m/s2", 0.1, 9.0);
    const bool all = options.manoeuvre == kAllManoeuvres;
    strings.brakes = all || options.manoeuvre == "brake";
    strings.starts = all || options.manoeuvre == "start";
    if (!all && options.manoeuvre != "swing") {
        if (options.sweep) throw InputError("--sweep needs swings; leave out --manoeuvre, or give --manoeuvre swing");
        if (!options.frequencies.empty()) {
            throw InputError("--frequency is for swings only; leave it out, or give --manoeuvre swing");
        }
        return strings;
    }
    for (const std::string& text : options.frequencies) {
        strings.frequencies_radps.push_back(quantity("--frequency", text, "", 0.01, 50.0));
    }
    if (options.frequencies.empty()) {
        // The border of string stability depends on the slow swings only.
        strings.frequencies_radps =
            options.sweep ? spaced_frequencies_radps(0.25, 1.6, 12) : spaced_frequencies_radps(0.15, 8.0, 18);
    }
    return strings;
}

std::string command_of(const StringsCliOptions& options) {
    const StringsCliOptions defaults;
    std::string command = command_text("stopline-strings", options.file, options.common);
    const auto add = [&](const char* name, const std::string& value, const std::string& by_default) {
        if (value != by_default) command += fmt::format(" {} {}", name, shell_word(value));
    };
    for (const std::string& name : options.populations) add("--population", name, "");
    add("--vehicles", std::to_string(options.vehicles), std::to_string(defaults.vehicles));
    add("--manoeuvre", options.manoeuvre, defaults.manoeuvre);
    add("--speed", options.speed, defaults.speed);
    add("--amplitude", options.amplitude, defaults.amplitude);
    for (const std::string& frequency : options.frequencies) add("--frequency", frequency, "");
    add("--deceleration", options.deceleration, defaults.deceleration);
    if (!options.sweep) return command;
    command += " --sweep";
    add("--delays", options.delays, defaults.delays);
    add("--time-gaps", options.time_gaps, defaults.time_gaps);
    return command;
}

std::filesystem::path output_folder(const StringsCliOptions& options) {
    return options.common.output.empty() ? "out/strings" : options.common.output;
}

using NamedText = std::pair<std::string, std::string>;

void write_results(const StringsCliOptions& options, const Scenario& scenario, const std::vector<NamedText>& tables,
                   const std::vector<std::pair<std::string, std::string>>& state_hashes,
                   const std::vector<Figure>& figures) {
    const std::filesystem::path folder = output_folder(options);
    Provenance provenance;
    provenance.command = command_of(options);
    provenance.state_hashes = state_hashes;
    fmt::print("\nWritten to {}\n", folder.string());
    for (const auto& [name, text] : tables) {
        write_file(folder / name, text);
        provenance.files.push_back(name);
        fmt::print("  {}\n", name);
    }
    write_file(folder / "strings.provenance.json", provenance_json(scenario, provenance));
    fmt::print("  strings.provenance.json\n");
    if (!options.no_figures) draw_figures(figures, folder);
}

ExitCode run_sweep(const StringsCliOptions& options, const Scenario& scenario, StringOptions strings) {
    // A message cannot arrive in the step in which it is sent.
    const double shortest_ms = 1e3 * scenario.tick_s();
    const std::string delays = options.delays.empty() ? kDefaultDelays : options.delays;
    const std::string time_gaps = options.time_gaps.empty() ? kDefaultTimeGaps : options.time_gaps;
    const StringSweepAxes axes{quantities("--delays", delays, "ms", shortest_ms, 2000.0),
                               quantities("--time-gaps", time_gaps, "s", 0.05, 10.0)};
    const StringSweep sweep = [&] {
        ProgressBar bar("sweep");
        strings.on_progress = [&bar](double share) { return bar.update(share); };
        return sweep_strings(scenario, strings, axes);
    }();
    fmt::print("{}", string_sweep_text(sweep));
    write_results(options, scenario, {{"sweep.csv", string_sweep_csv(sweep)}, {"border.csv", string_border_csv(sweep)}},
                  {}, {string_border_figure(sweep)});
    fmt::print("{}", runnable("\nNext: one platoon in detail\n"
                              "  stopline-strings --population CTG-Ref --set 'driver.cacc.v2v_delay=150 ms'\n"));
    return sweep.violations.none() ? ExitCode::done : ExitCode::check_failed;
}

ExitCode run_report(const StringsCliOptions& options, const Scenario& scenario, StringOptions strings) {
    const StringReport report = [&] {
        ProgressBar bar(fmt::format("{} platoons", scenario.populations.size()));
        strings.on_progress = [&bar](double share) { return bar.update(share); };
        return run_strings(scenario, strings);
    }();
    fmt::print("Platoons of {} vehicles {} with driver {}, at {:.1f} km/h\n\n{}", strings.vehicles,
               scenario.vehicle_name, scenario.driver_name, strings.speed_mps * kKmhPerMps, string_text(report));
    std::vector<std::pair<std::string, std::string>> hashes;
    for (const StringResult& result : report.populations) {
        StateHash combined;
        for (const std::uint64_t hash : result.state_hashes) combined.add(hash);
        hashes.emplace_back(result.population, fmt::format("{:016x}", combined.value()));
    }
    std::vector<NamedText> tables{{"summary.csv", string_summary_csv(report)},
                                  {"positions.csv", string_positions_csv(report)}};
    if (!strings.frequencies_radps.empty()) tables.emplace_back("gains.csv", string_gains_csv(report));
    write_results(options, scenario, tables, hashes, string_figures(report));
    fmt::print("{}", runnable("\nNext: find the border of string stability\n"
                              "  stopline-strings --sweep --population CTG-Ref\n"));
    return report.no_violations() ? ExitCode::done : ExitCode::check_failed;
}

ExitCode run(const StringsCliOptions& options) {
    const std::string file =
        options.file.empty() ? (scenario_directory() / "single_light.yaml").string() : options.file;
    Scenario scenario = load_with_options(file, options.common);
    choose_populations(options.populations, scenario);
    check_platoon_scenario(scenario);
    const StringOptions strings = string_options(options, scenario);
    CommandFiles files;
    add_scenario_inputs(files, file, options.common);
    files.add_outputs(
        output_folder(options),
        {"summary.csv", "positions.csv", "gains.csv", "sweep.csv", "border.csv", "strings.provenance.json"},
        "a result in the folder of --output");
    prepare_folder(output_folder(options));
    return options.sweep ? run_sweep(options, scenario, strings) : run_report(options, scenario, strings);
}

}  // namespace

int strings_main(int argc, const char* const* argv) {
    return run_program("stopline-strings", [&] {
        Options app("Measures the string stability of platoons and compares it with the linear analysis.",
                    "stopline-strings");
        StringsCliOptions options;
        declare(app, options);
        const std::optional<ExitCode> end = app.parse(argc, argv);
        return end ? *end : run(options);
    });
}

}  // namespace stopline

int main(int argc, char** argv) { return stopline::strings_main(argc, argv); }

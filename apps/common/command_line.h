// Command-line options that all programs share.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/io/command_files.h"
#include "common/options.h"
#include "runs/tables/column_aliases.h"
#include "scenario/scenario.h"
#include "scenario/sweep_file/sweep_settings.h"

namespace stopline {

struct CommonOptions {
    int threads = 0;  // number of threads; 0: one per processor
    std::optional<std::uint64_t> seed;
    std::string output;

    std::vector<std::string> settings;  // values of --set
    bool old_column_names = false;      // true: columns of tables have the names of the previous release
};

// Adds --threads, --seed and --output.
void add_common_options(Options& app, CommonOptions& options, const std::string& output_help);

// Adds --set, which can be repeated.
void add_set_option(Options& app, CommonOptions& options);

// Adds --old-column-names.
void add_old_column_names_option(Options& app, CommonOptions& options);
// Returns whether result tables get current or old column names. Prints a warning on standard error for old names.
ColumnNames column_names(const CommonOptions& options);

// Prints warnings on standard error, with "warning: " before each. Skips warnings that it has printed before.
void print_warnings(const std::vector<std::string>& warnings);

// Loads the scenario, applies --set and --seed, and prints the warnings of loading. Throws InputError if the scenario
// is invalid.
Scenario load_with_options(const std::string& file, const CommonOptions& options);

// Adds the scenario file and all files that it names to the inputs of the command. Call it after load_with_options().
void add_scenario_inputs(CommandFiles& files, const std::string& file, const CommonOptions& options);

// Adds the sweep file, its scenario, and all files that they name to the inputs of the command. `overrides` are the
// settings of the whole sweep.
void add_sweep_inputs(CommandFiles& files, const std::string& sweep_file, const SweepSettings& sweep,
                      const std::vector<std::string>& overrides);

// Returns a line of the 'Next:' hint, such as "  other greens: add --set 'signal.green=10 s'". Leaves out each setting
// that the scenario refuses. Returns an empty text if it refuses all of them.
std::string settings_hint(const std::string& file, const CommonOptions& options, const std::string& purpose,
                          const std::vector<std::string>& settings);

// Adds the setting fidelity=meso. Warns on standard error if --set asks for another fidelity.
void set_mesoscale(const char* program, CommonOptions& options);

// Returns `text` quoted for a shell.
std::string shell_word(const std::string& text);

// Returns the command that reproduces the results. It omits --threads and --output, which do not affect the results,
// and --old-column-names.
std::string command_text(const std::string& program, const std::string& file, const CommonOptions& options);

// Returns a list of names for scenario files: policies, spacing laws, vehicles, drivers and streets. If `file` is not
// empty, the list shows the policies and populations of that scenario.
std::string list_text(const std::string& file, const CommonOptions& options);

// Adds --population, which can be repeated.
void add_population_option(Options& app, std::vector<std::string>& names, const std::string& default_text);

// Replaces the populations of the scenario by those with the names, if there are any. A name is that of a population of
// the scenario, or that of a policy which all vehicles follow. Throws InputError for an unknown name.
void choose_populations(const std::vector<std::string>& names, Scenario& scenario);

}  // namespace stopline

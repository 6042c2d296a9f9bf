// Command-line options that all programs share.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>


#include "common/options.h"
#include "scenario/scenario.h"

namespace stopline {

struct CommonOptions {
    int threads = 0;  // 0: all processors
    std::optional<std::uint64_t> seed;
    std::string output;

    std::vector<std::string> settings;  // values of --set
};

// Adds --threads, --seed and --output.
void add_common_options(Options& app, CommonOptions& options, const std::string& output_help);

// Adds --set, which can be repeated.
void add_set_option(Options& app, CommonOptions& options);

// Prints each warning once per program run on standard error, with "warning: " before it.
void print_warnings(const std::vector<std::string>& warnings);

// Loads the scenario, applies --set and --seed, and prints the warnings of loading. Throws InputError.
Scenario load_with_options(const std::string& file, const CommonOptions& options);

// Adds the setting fidelity=meso. Warns on standard error if --set asks for another fidelity.
void set_mesoscale(const char* program, CommonOptions& options);

// Returns `text` quoted for a shell.
std::string shell_word(const std::string& text);

// Returns the command that reproduces the results. It omits --threads and --output, which do not affect them.
std::string command_text(const std::string& program, const std::string& file, const CommonOptions& options);

// Returns the names that a scenario can use: policies, spacing laws, vehicles, drivers and streets.
// If `file` is not empty, its policies and populations are listed as well.
std::string list_text(const std::string& file, const CommonOptions& options);

}  // namespace stopline

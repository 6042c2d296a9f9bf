// The command line that all programs share, on top of CLI11.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/program.h"
#include "scenario/scenario.h"

namespace stopline {

struct CommonOptions {
    int threads = 0;  // 0: all of the machine
    std::optional<std::uint64_t> seed;
    std::string output;

    std::vector<std::string> settings;  // --set, of programs that run a scenario
};

// --help, --version.
void add_version_option(CLI::App& app);

// --help, --version, --threads, --seed, --output.
void add_common_options(CLI::App& app, CommonOptions& options, const std::string& output_help);

// --set, repeatable.
void add_set_option(CLI::App& app, CommonOptions& options);

// Parses. The exit code where the program is to end now: after --help and --version, or with a message after wrong usage.
std::optional<ExitCode> parse_command_line(CLI::App& app, int argc, const char* const* argv);

// The scenario with --set and --seed applied.
Scenario load_with_options(const std::string& file, const CommonOptions& options);

// For programs that run nothing else: says on standard error which --set is not used for that.
void set_mesoscale(const char* program, CommonOptions& options);

// Quoted as a shell needs it.
std::string shell_word(const std::string& text);

// The command that makes the results again: --threads and --output do not belong to it, since they change nothing in them.
std::string command_text(const std::string& program, const std::string& file, const CommonOptions& options);

// What can be named in a scenario: policies, laws, vehicles, drivers, streets, and the populations of `file` unless it is empty.
std::string list_text(const std::string& file, const CommonOptions& options);

}  // namespace stopline

// Command-line options of a program. This header hides CLI11, which parses them, because CLI11 compiles slowly.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/program.h"

namespace CLI {  // NOLINT(readability-identifier-naming): the library's name
class App;
class Option;
}  // namespace CLI

namespace stopline {

// Handle to one option, to set its details. Each function returns the handle itself.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}

    Option& required();
    // Sets the placeholder of the value in the help text, such as FILE.
    Option& type_name(const std::string& name);
    // Accepts only whole numbers from `low` to `high`, which must not be negative.
    Option& range(int low, int high);
    // Accepts only the given texts as value.
    Option& one_of(const std::vector<std::string>& texts);
    // Takes exactly one value each time the user gives the option.
    Option& one_value_each();
    // Shows the initial value of the variable as default in the help text.
    Option& show_default();

private:
    CLI::Option* option_;
};

// The options of a program or of one of its subcommands. Parsing stores values in the variables passed to add(), which
// must outlive this object.
class Options {
public:
    // Makes the options of a program, with --help and --version.
    Options(const std::string& description, const std::string& program);
    ~Options();
    Options(const Options&) = delete;
    Options(Options&&) = delete;
    Options& operator=(const Options&) = delete;
    Options& operator=(Options&&) = delete;

    // Adds an option or a positional argument. `names` follows CLI11: "--output", "FILE", "-n,--name".
    Option add(const std::string& names, std::string& value, const std::string& help);
    Option add(const std::string& names, int& value, const std::string& help);
    // Adds an option for a seed, which is a whole number.
    Option add(const std::string& names, std::optional<std::uint64_t>& value, const std::string& help);
    Option add(const std::string& names, std::vector<std::string>& values, const std::string& help);
    // Adds an option without a value. `value` becomes true if the user gives the option.
    Option add_flag(const std::string& names, bool& value, const std::string& help);

    // Adds a subcommand. Returns its options; this object owns them.
    Options& add_subcommand(const std::string& name, const std::string& help);
    // Returns true if the command line named this subcommand.
    bool parsed() const;

    // Accepts options that have not been added. parse() stores them in the returned list.
    const std::vector<std::string>& accept_others();

    // Sets the text below the options in the help text.
    void footer(const std::string& text);

    // Parses the command line. Returns an exit code if the program must end at once, because the user asked for --help
    // or --version or because the command line is wrong.
    std::optional<ExitCode> parse(int argc, const char* const* argv);

private:
    explicit Options(CLI::App* subcommand);

    CLI::App* app_;
    bool owns_app_;
    std::vector<Options*> subcommands_;
    std::vector<std::string> others_;
};

}  // namespace stopline

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

class Options;

// Handle to one option, to set its details. Each function returns the handle itself.
class Option {
public:
    Option(CLI::Option* option, Options& options) : option_(option), options_(options) {}

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
    // Refuses the option unless the command line has one of these other options, without which it has no effect.
    Option& only_with(const std::vector<std::string>& others);

private:
    CLI::Option* option_;
    Options& options_;
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

    // Adds an option or a positional argument. `names` follows CLI11: "--output", "FILE", "-n,--name". An option that
    // takes text refuses an empty text.
    Option add(const std::string& names, std::string& value, const std::string& help);
    Option add(const std::string& names, int& value, const std::string& help);
    // Adds an option for a seed, which is a whole number.
    Option add(const std::string& names, std::optional<std::uint64_t>& value, const std::string& help);
    Option add(const std::string& names, std::vector<std::string>& values, const std::string& help);
    // Adds an option that the user can give with or without a text. Without a text, `value`
    // becomes empty text. Without the option, it stays unset.
    Option add_optional(const std::string& names, std::optional<std::string>& value, const std::string& help);
    // Adds an option without a value. `value` becomes true if the user gives the option.
    Option add_flag(const std::string& names, bool& value, const std::string& help);

    // Adds a subcommand. Returns its options; this object owns them.
    Options& add_subcommand(const std::string& name, const std::string& help);
    // Returns true if the command line named this subcommand.
    bool parsed() const;
    // Returns the names of the options and arguments that the command line gives, without those of subcommands.
    std::vector<std::string> given() const;

    // Accepts options that have not been added. parse() stores them in the returned list.
    const std::vector<std::string>& accept_others();

    // Sets the text below the options in the help text.
    void footer(const std::string& text);

    // Parses the command line. Returns an exit code if the program must end at once, because the user asked for --help
    // or --version or because the command line is wrong.
    std::optional<ExitCode> parse(int argc, const char* const* argv);

private:
    friend class Option;
    // An option that has an effect only with one of the `others`.
    struct Dependent {
        CLI::Option* option;
        std::vector<std::string> others;
    };

    explicit Options(CLI::App* subcommand);
    Option add_text(CLI::Option* option);
    // Throws InputError if the command line has an option without another one that it needs.
    void check_dependents() const;
    // Returns the first argument that is not an option, such as the scenario; empty if there is none.
    std::string first_argument() const;

    CLI::App* app_;
    bool owns_app_;
    std::vector<Options*> subcommands_;
    std::vector<Dependent> dependents_;
    std::vector<std::string> others_;
};

}  // namespace stopline

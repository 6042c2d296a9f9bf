// Command-line options of a program. CLI11 parses them; it is hidden here because it compiles slowly.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/program.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace stopline {

// An option that has been added, to set its details. Each function returns the option itself.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}

    Option& required();
    // Sets the placeholder of the value in the help text, such as FILE.
    Option& type_name(const std::string& name);
    // Accepts whole numbers from `low` to `high` only.
    Option& range(int low, int high);
    // Accepts these texts only.
    Option& one_of(const std::vector<std::string>& texts);
    // Takes one value each time the option is given.
    Option& one_value_each();
    // Shows the present value as default in the help text.
    Option& show_default();

private:
    CLI::Option* option_;
};

// The options of a program or of one of its subcommands. Variables must outlive the object; parsing fills them.
class Options {
public:
    // Makes the options of a program, with --help and --version.
    Options(const std::string& description, const std::string& program);
    ~Options();
    Options(const Options&) = delete;
    Options& operator=(const Options&) = delete;

    // Adds an option or a positional argument, as CLI11 names them: "--output", "FILE", "-n,--name".
    Option add(const std::string& names, std::string& value, const std::string& help);
    Option add(const std::string& names, int& value, const std::string& help);
    Option add(const std::string& names, std::optional<std::uint64_t>& value, const std::string& help);
    Option add(const std::string& names, std::vector<std::string>& values, const std::string& help);
    // Adds an option that is true if it is given.
    Option add_flag(const std::string& names, bool& value, const std::string& help);

    // Adds a subcommand. The object belongs to this one.
    Options& add_subcommand(const std::string& name, const std::string& help);
    // Returns true if the command line named this subcommand.
    bool parsed() const;

    // Accepts options that are not known here. The returned list holds them after parsing.
    const std::vector<std::string>& accept_others();

    // Sets the text below the options in the help.
    void footer(const std::string& text);

    // Parses the command line. Returns an exit code if the program must end now: after --help, --version or wrong usage.
    std::optional<ExitCode> parse(int argc, const char* const* argv);

private:
    explicit Options(CLI::App* subcommand);

    CLI::App* app_;
    bool owns_app_;
    std::vector<Options*> subcommands_;
    std::vector<std::string> others_;
};

}  // namespace stopline

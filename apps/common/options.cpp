#include "common/options.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "base/input_error.h"
#include "base/io/console.h"
#include "base/version.h"
#include "common/examples.h"
#include "scenario/schema/quantity.h"

namespace stopline {

namespace {

// Parses a seed. CLI11 would accept -1 and too large numbers, so the program reads the seed as text.
std::uint64_t parse_seed(const std::string& names, const std::string& text) {
    const ParsedWhole seed = parse_whole(text);
    if (!seed.problem.empty()) {
        throw CLI::ValidationError(names,
                                   fmt::format("value '{}' {}; give a whole number such as 1", text, seed.problem));
    }
    return seed.value;
}

std::string problem_of_empty_text(const std::string& text) {
    return text.empty() ? "the value is empty; give a text, or leave the option out" : "";
}

}  // namespace

Option& Option::required() {
    option_->required();
    return *this;
}

Option& Option::type_name(const std::string& name) {
    option_->type_name(name);
    return *this;
}

Option& Option::range(int low, int high) {
    const auto problem_of = [low, high](const std::string& text) -> std::string {
        const ParsedWhole number = parse_whole(text);
        const auto min = static_cast<std::uint64_t>(low);
        const auto max = static_cast<std::uint64_t>(high);
        if (number.problem.empty() && number.value >= min && number.value <= max) return "";
        return fmt::format("value '{}' is not allowed; give a whole number from {} to {}", text, low, high);
    };
    option_->check(problem_of, fmt::format("{} to {}", low, high));
    return *this;
}

Option& Option::one_of(const std::vector<std::string>& texts) {
    const auto problem_of = [texts](const std::string& text) -> std::string {
        if (std::find(texts.begin(), texts.end(), text) != texts.end()) return "";
        return fmt::format("value '{}' is not allowed; allowed: {}", text, fmt::join(texts, ", "));
    };
    option_->check(problem_of, fmt::format("{{{}}}", fmt::join(texts, ",")));
    return *this;
}

Option& Option::one_value_each() {
    option_->allow_extra_args(false);
    return *this;
}

Option& Option::show_default() {
    option_->capture_default_str();
    return *this;
}

Option& Option::only_with(const std::vector<std::string>& others) {
    options_.dependents_.push_back({option_, others});
    return *this;
}

Options::Options(const std::string& description, const std::string& program)
    : app_(new CLI::App(description, program)), owns_app_(true) {
    app_->get_formatter()->column_width(34);
    app_->set_version_flag("--version", std::string("stopline ") + version(), "Print the version and exit");
}

Options::Options(CLI::App* subcommand) : app_(subcommand), owns_app_(false) {}

Options::~Options() {
    for (const Options* const subcommand : subcommands_) delete subcommand;
    if (owns_app_) delete app_;
}

Option Options::add_text(CLI::Option* option) {
    option->check(problem_of_empty_text, "");
    return {option, *this};
}

Option Options::add(const std::string& names, std::string& value, const std::string& help) {
    return add_text(app_->add_option(names, value, help));
}

Option Options::add(const std::string& names, int& value, const std::string& help) {
    return {app_->add_option(names, value, help), *this};
}

Option Options::add(const std::string& names, std::optional<std::uint64_t>& value, const std::string& help) {
    const auto store = [&value, names](const std::string& text) { value = parse_seed(names, text); };
    return Option(app_->add_option_function<std::string>(names, store, help), *this).type_name("S");
}

Option Options::add(const std::string& names, std::vector<std::string>& values, const std::string& help) {
    return add_text(app_->add_option(names, values, help));
}

Option Options::add_flag(const std::string& names, bool& value, const std::string& help) {
    return {app_->add_flag(names, value, help), *this};
}

Options& Options::add_subcommand(const std::string& name, const std::string& help) {
    subcommands_.push_back(new Options(app_->add_subcommand(name, help)));
    return *subcommands_.back();
}

bool Options::parsed() const { return app_->parsed(); }

std::vector<std::string> Options::given() const {
    std::vector<std::string> names;
    for (const CLI::Option* const option : app_->get_options()) {
        if (option->count() > 0) names.push_back(option->get_name());
    }
    return names;
}

void Options::check_dependents() const {
    for (const Dependent& dependent : dependents_) {
        const auto is_given = [&](const std::string& other) { return app_->get_option(other)->count() > 0; };
        if (dependent.option->count() == 0) continue;
        if (std::any_of(dependent.others.begin(), dependent.others.end(), is_given)) continue;
        throw InputError(fmt::format("{} has an effect only with {}; add it", dependent.option->get_name(),
                                     fmt::join(dependent.others, " or ")));
    }
    for (const Options* const subcommand : subcommands_) subcommand->check_dependents();
}

std::string Options::first_argument() const {
    for (const CLI::Option* const option : app_->get_options()) {
        if (option->get_positional() && option->count() > 0) return option->results().front();
    }
    for (const Options* const subcommand : subcommands_) {
        if (std::string argument = subcommand->first_argument(); !argument.empty()) return argument;
    }
    return {};
}

const std::vector<std::string>& Options::accept_others() {
    app_->allow_extras();
    return others_;
}

void Options::footer(const std::string& text) { app_->footer(text); }

std::optional<ExitCode> Options::parse(int argc, const char* const* argv) {
    try {
        app_->parse(argc, argv);
        others_ = app_->remaining();
        check_dependents();
        set_input_name(first_argument());
    } catch (const CLI::Success& success) {
        app_->exit(success);  // prints the help or the version
        return ExitCode::done;
    } catch (const CLI::ParseError& error) {
        print_message("{}: {}\nTry: {} --help\n", app_->get_name(), error.what(), program_command(app_->get_name()));
        return ExitCode::bad_input;
    }
    return std::nullopt;
}

}  // namespace stopline

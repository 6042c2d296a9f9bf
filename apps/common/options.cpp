#include "common/options.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "base/input_error.h"
#include "base/io/console.h"
#include "base/nearest_name.h"
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

bool is_option(const std::string& word) { return word.size() > 1 && word.front() == '-'; }

bool has_open_bracket(const std::string& text) {
    const auto opening = std::count_if(text.begin(), text.end(), [](char c) { return c == '[' || c == '{'; });
    const auto closing = std::count_if(text.begin(), text.end(), [](char c) { return c == ']' || c == '}'; });
    return opening > closing;
}

bool is_unit(const std::string& word) {
    return std::any_of(units().begin(), units().end(),
                       [&](const Unit& one) { return !one.text.empty() && one.text == word; });
}

// A command line with unknown words.
class UnknownWords {
public:
    UnknownWords(const CLI::App& app, std::vector<std::string> words)
        : app_(app), words_(std::move(words)), unknown_(app.remaining(true)) {}

    // Returns the message about the unknown words, in their order on the command line.
    std::string message() const {
        if (std::string text = unquoted_setting(); !text.empty()) return text;
        std::vector<std::string> problems;
        for (std::size_t k = 0; k < words_.size(); ++k) {
            if (!is_unknown(words_[k])) continue;
            const bool is_value = k > 0 && is_option(words_[k - 1]) && is_unknown(words_[k - 1]);
            if (is_option(words_[k])) {
                problems.push_back(option_problem(k));
            } else if (!is_value) {
                problems.push_back(fmt::format("the argument '{}' is not expected", words_[k]));
            }
        }
        return fmt::format("{}", fmt::join(problems, ", "));
    }

private:
    bool is_unknown(const std::string& word) const {
        return std::find(unknown_.begin(), unknown_.end(), word) != unknown_.end();
    }

    bool has_option(const std::string& name) const {
        const std::vector<std::string> names = option_names();
        return std::find(names.begin(), names.end(), name) != names.end();
    }

    // Returns the long names of all options that the command line may have, with those of the named subcommands.
    std::vector<std::string> option_names() const {
        std::vector<std::string> names;
        std::vector<const CLI::App*> apps{&app_};
        for (const CLI::App* const subcommand : app_.get_subcommands()) apps.push_back(subcommand);
        for (const CLI::App* const app : apps) {
            for (const CLI::Option* const option : app->get_options()) {
                for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
            }
        }
        return names;
    }

    // Returns the message about the unknown option that is word k.
    std::string option_problem(std::size_t k) const {
        const std::string name = words_[k].substr(0, words_[k].find('='));
        if (name == "--population" && has_option("--set")) {
            std::string value = "NAME";
            if (name != words_[k]) {
                value = words_[k].substr(name.size() + 1);
            } else if (k + 1 < words_.size() && is_unknown(words_[k + 1])) {
                value = words_[k + 1];
            }
            return fmt::format("unknown option '{}' (write --set 'populations=[{}]' instead)", name, value);
        }
        const std::string nearest = nearest_name(name, option_names());
        return fmt::format("unknown option '{}'{}", name,
                           nearest.empty() ? "" : fmt::format(" (did you mean '{}'?)", nearest));
    }

    // Returns the message about a value of --set with a blank, such as signal.green=20 s, that lacks quotes. Returns ""
    // if there is none.
    std::string unquoted_setting() const {
        for (std::size_t k = 0; k + 2 < words_.size(); ++k) {
            if (words_[k] != "--set") continue;
            std::string setting = words_[k + 1];
            const bool is_quoted = setting.find(' ') != std::string::npos && !has_open_bracket(setting);
            if (is_quoted) continue;
            for (std::size_t next = k + 2; next < words_.size() && !is_option(words_[next]); ++next) {
                const bool ends_here = !has_open_bracket(setting) && is_unit(words_[next]);
                if (!ends_here && !has_open_bracket(setting) && !is_unknown(words_[next])) break;
                setting += " " + words_[next];
                if (ends_here) break;
            }
            if (setting.size() == words_[k + 1].size()) continue;
            return fmt::format("the value of --set has a blank, so it needs quotes: write --set '{}'", setting);
        }
        return {};
    }

    const CLI::App& app_;
    std::vector<std::string> words_;
    std::vector<std::string> unknown_;
};

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

Option Options::add_optional(const std::string& names, std::optional<std::string>& value, const std::string& help) {
    const auto store = [&value](const std::string& text) { value = text; };
    return {app_->add_option_function<std::string>(names, store, help)->expected(0, 1), *this};
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
        // A misspelt option can be the reason why a required one is missing.
        const bool has_unknown_words = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr ||
                                       dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
        const std::string problem = has_unknown_words ? UnknownWords(*app_, {argv + 1, argv + argc}).message() : "";
        print_message("{}: {}\nTry: {} --help\n", app_->get_name(), problem.empty() ? error.what() : problem,
                      program_command(app_->get_name()));
        return ExitCode::bad_input;
    }
    return std::nullopt;
}

}  // namespace stopline

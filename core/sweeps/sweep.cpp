#include "sweeps/sweep.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/input_error.h"
#include "base/nearest_name.h"
#include "base/text_hash.h"
#include "runs/interrupted.h"
#include "runs/run_metrics.h"
#include "scenario/load_scenario.h"
#include "scenario/schema/field_path.h"
#include "scenario/schema/fields.h"
#include "scenario/schema/quantity.h"
#include "scenario/sweep_file/axis_column.h"
#include "scenario/sweep_file/load_sweep.h"

namespace stopline {

namespace {

std::vector<std::string> names_of_populations(const Scenario& scenario) {
    std::vector<std::string> names;
    for (const PopulationSettings& population : scenario.populations) names.push_back(population.name);
    return names;
}

std::string no_population_text(const std::string& name) { return fmt::format("has no population '{}'", name); }

// Returns the end of the message about an unknown population.
std::string population_hint(const Scenario& scenario, const std::string& name) {
    const std::vector<std::string> known = names_of_populations(scenario);
    if (name == kAllPopulations) {
        return fmt::format("; to run all populations, write 'populations: {}' without other names (known: {})", name,
                           fmt::join(known, ", "));
    }
    const bool is_policy = std::any_of(scenario.policies.begin(), scenario.policies.end(),
                                       [&](const GapPolicySettings& policy) { return policy.name == name; });
    if (!is_policy) return known_names_hint(name, known);
    return fmt::format(", but a policy of this name: add it to the field 'populations' of the scenario (known: {})",
                       fmt::join(known, ", "));
}

void require_populations(const Scenario& scenario, const std::vector<std::string>& wanted) {
    const std::vector<std::string> known = names_of_populations(scenario);
    for (const std::string& name : wanted) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        throw InputError(fmt::format("the scenario {} {}{}", scenario.name, no_population_text(name),
                                     population_hint(scenario, name)));
    }
}

// Returns true if both paths name the same field, or if one of the fields contains the other.
bool overlap(const std::string& a, const std::string& b) {
    const auto contains = [](const std::string& section, const std::string& path) {
        return path.rfind(section, 0) == 0 &&
               (path.size() == section.size() || path[section.size()] == '.' || path[section.size()] == '[');
    };
    return contains(a, b) || contains(b, a);
}

// Throws InputError if two axes change the same field. One axis would overwrite the values of the other.
void check_axes_are_independent(const SweepSettings& settings) {
    std::vector<std::pair<std::string, std::string>> earlier;  // path and name of its axis
    for (const SweepAxis& axis : settings.axes) {
        for (const std::string& path : axis.paths) {
            const auto same = std::find_if(earlier.begin(), earlier.end(), [&](const auto& other) {
                return other.second != axis.name && overlap(path, other.first);
            });
            if (same != earlier.end()) {
                throw InputError(fmt::format("{}: the axes '{}' and '{}' both change '{}': make them one axis",
                                             axis.place, same->second, axis.name, std::max(path, same->first)));
            }
            earlier.emplace_back(path, axis.name);
        }
    }
}

// Throws InputError if an override from --set changes a field that an axis also changes. The axis would overwrite the
// value from --set.
void check_overrides(const SweepSettings& settings, const std::vector<std::string>& overrides) {
    for (const std::string& text : overrides) {
        const std::string path = current_path(scenario_table(), text.substr(0, text.find('=')));
        for (const SweepAxis& axis : settings.axes) {
            for (const std::string& changed : axis.paths) {
                if (!overlap(path, changed)) continue;
                throw InputError(
                    fmt::format("--set '{}': '{}' is an axis of the sweep ('{}')", text, changed, axis.name));
            }
        }
    }
}

// Returns a * b, or the largest std::size_t if the product overflows.
std::size_t product(std::size_t a, std::size_t b) {
    std::size_t result = 0;
    return __builtin_mul_overflow(a, b, &result) ? std::numeric_limits<std::size_t>::max() : result;
}

}  // namespace

Sweep::Sweep(SweepSettings settings, const SweepOptions& options)
    : settings_(std::move(settings)), overrides_(options.overrides) {
    check_axes_are_independent(settings_);
    check_overrides(settings_, overrides_);
    base_ = load_scenario(settings_.scenario, overrides_);
    add_warnings(settings_.warnings);
    add_warnings(base_.warnings);
    add_columns();
    std::size_t combinations = 1;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        if (k != population_column_) combinations = product(combinations, columns_[k].cells.size());
    }
    const std::size_t runs = product(product(combinations, columns_[population_column_].cells.size()),
                                     static_cast<std::size_t>(settings_.repetitions));
    if (runs > kSweepPointsMax) {
        const std::string count = runs == std::numeric_limits<std::size_t>::max() ? "" : fmt::format(" ({})", runs);
        throw InputError(
            fmt::format("{}: the sweep has more than {} runs{}: leave out values, or split it into several sweeps",
                        settings_.file, kSweepPointsMax, count));
    }
    load_combinations(combinations, options);
}

void Sweep::add_columns() {
    population_column_ = settings_.axes.size();  // the last column, unless an axis selects populations
    for (std::size_t k = 0; k < settings_.axes.size(); ++k) {
        const SweepAxis& axis = settings_.axes[k];
        Column column;
        column.axis = axis.name;
        column.axis_index = k;
        if (!axis.populations.empty()) {
            population_column_ = k;
            const bool all = axis.populations == std::vector<std::string>{kAllPopulations};
            column.cells = all ? names_of_populations(base_) : axis.populations;
            column.shown = column.titles = column.cells;
            column.name = axis.name;
        } else {
            AxisColumn of_fields = axis_column(axis);
            column.name = std::move(of_fields.name);
            column.cells = std::move(of_fields.cells);
            column.titles = std::move(of_fields.titles);
            column.shown = axis.values;
        }
        columns_.push_back(std::move(column));
    }
    if (population_column_ < columns_.size()) return;
    const std::vector<std::string> all = names_of_populations(base_);
    columns_.push_back({"population", "population", all, all, all, 0});
}

void Sweep::load_combinations(std::size_t count, const SweepOptions& options) {
    hashes_.assign(count, 0);
    std::atomic<std::size_t> loaded = 0;
    std::atomic<std::size_t> first_bad = count;
    std::atomic<bool> stopped = false;
    std::mutex mutex;
    std::exception_ptr error;
    std::set<std::string> results;
    std::set<std::string> warnings;
#pragma omp parallel for schedule(dynamic) num_threads(std::max(1, options.threads))
    for (std::size_t i = 0; i < count; ++i) {
        if (stopped || i > first_bad) continue;
        try {
            const Scenario loaded_scenario = load_scenario(settings_.scenario, overrides(i));
            require_populations(loaded_scenario, columns_[population_column_].cells);
            hashes_[i] = loaded_scenario.hash;
            const std::vector<std::string> columns = result_columns(loaded_scenario);
            const std::lock_guard lock(mutex);
            results.insert(columns.begin(), columns.end());
            warnings.insert(loaded_scenario.warnings.begin(), loaded_scenario.warnings.end());
        } catch (const InputError& bad) {
            const std::lock_guard lock(mutex);
            if (i >= first_bad) continue;
            first_bad = i;
            error = std::make_exception_ptr(
                InputError(fmt::format("{}: the sweep {}{}: {}", place_of_problem(i, bad.what()), settings_.name,
                                       describe_combination(i), bad.what())));
        } catch (...) {
            const std::lock_guard lock(mutex);
            if (!error) error = std::current_exception();
        }
        ++loaded;
        if (!options.on_progress) continue;
        const std::lock_guard lock(mutex);
        if (!stopped) stopped = !options.on_progress(static_cast<double>(loaded) / static_cast<double>(count));
    }
    if (stopped) throw Interrupted();
    if (error) std::rethrow_exception(error);
    check_column_names(results);
    add_warnings({warnings.begin(), warnings.end()});
}

void Sweep::add_warnings(const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) {
        if (std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end()) warnings_.push_back(warning);
    }
}

void Sweep::check_column_names(std::set<std::string> taken) const {
    for (const Column& column : columns_) {
        if (taken.insert(column.name).second) continue;
        const SweepAxis& axis = settings_.axes[column.axis_index];
        const std::string as = column.name == axis.name ? "" : fmt::format(" (as '{}')", axis.name);
        throw InputError(
            fmt::format("{}: field 'axes[{}].name': the table of results has another column '{}'{}: rename the axis",
                        axis.place, axis.name, column.name, as));
    }
}

std::size_t Sweep::points() const {
    return hashes_.size() * columns_[population_column_].cells.size() * static_cast<std::size_t>(settings_.repetitions);
}

std::vector<std::string> Sweep::columns() const {
    std::vector<std::string> names;
    for (const Column& column : columns_) names.push_back(column.name);
    return names;
}

CellTitles Sweep::titles() const {
    CellTitles titles;
    for (const Column& column : columns_) {
        for (std::size_t i = 0; i < column.cells.size(); ++i) {
            titles[{column.name, column.cells[i]}] = fmt::format("{} {}", column.axis, column.titles[i]);
        }
    }
    return titles;
}

std::vector<std::size_t> Sweep::value_indices(std::size_t point) const {
    std::vector<std::size_t> indices(columns_.size());
    std::size_t rest = point / static_cast<std::size_t>(settings_.repetitions);
    for (std::size_t k = columns_.size(); k-- > 0;) {
        indices[k] = rest % columns_[k].cells.size();
        rest /= columns_[k].cells.size();
    }
    return indices;
}

std::vector<std::string> Sweep::cells(std::size_t point) const {
    const std::vector<std::size_t> values = value_indices(point);
    std::vector<std::string> cells;
    for (std::size_t k = 0; k < columns_.size(); ++k) cells.push_back(columns_[k].cells[values[k]]);
    return cells;
}

std::uint64_t Sweep::seed(std::size_t point) const {
    return base_.seed + point % static_cast<std::size_t>(settings_.repetitions);
}

std::string Sweep::population(std::size_t point) const {
    return columns_[population_column_].cells[value_indices(point)[population_column_]];
}

std::size_t Sweep::combination(std::size_t point) const {
    const std::vector<std::size_t> values = value_indices(point);
    std::size_t combination = 0;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        if (k != population_column_) combination = combination * columns_[k].cells.size() + values[k];
    }
    return combination;
}

std::string Sweep::describe(std::size_t point) const {
    const std::vector<std::size_t> values = value_indices(point);
    std::string text;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        text += fmt::format("{} = {}, ", columns_[k].axis, columns_[k].shown[values[k]]);
    }
    return text + fmt::format("seed = {}", seed(point));
}

std::string Sweep::describe_combination(std::size_t combination) const {
    std::string text;
    for (std::size_t k = columns_.size(); k-- > 0;) {
        if (k == population_column_) continue;
        const std::size_t count = columns_[k].cells.size();
        text = fmt::format("{} = {}", columns_[k].axis, columns_[k].shown[combination % count]) +
               (text.empty() ? "" : ", " + text);
        combination /= count;
    }
    return text.empty() ? "" : ", with " + text;
}

std::vector<std::size_t> Sweep::values_of(std::size_t combination) const {
    std::vector<std::size_t> values(columns_.size());
    for (std::size_t k = columns_.size(); k-- > 0;) {
        if (k == population_column_) continue;
        values[k] = combination % columns_[k].cells.size();
        combination /= columns_[k].cells.size();
    }
    return values;
}

std::string Sweep::place_of_population(const std::string& problem) const {
    for (const SweepAxis& axis : settings_.axes) {
        for (std::size_t i = 0; i < axis.population_places.size(); ++i) {
            if (problem.find(no_population_text(axis.populations[i])) != std::string::npos) {
                return axis.population_places[i];
            }
        }
    }
    return {};
}

bool Sweep::fails_alone(const SweepAxis& axis, std::size_t value) const {
    std::vector<std::string> texts = overrides_;
    for (std::string& text : axis_overrides(axis, value)) texts.push_back(std::move(text));
    try {
        load_scenario(settings_.scenario, texts);
    } catch (const InputError&) {
        return true;
    }
    return false;
}

std::string Sweep::place_of_problem(std::size_t combination, const std::string& problem) const {
    if (std::string place = place_of_population(problem); !place.empty()) return place;
    const std::vector<std::size_t> values = values_of(combination);
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        if (k == population_column_) continue;
        const SweepAxis& axis = settings_.axes[columns_[k].axis_index];
        if (fails_alone(axis, values[k])) return axis.value_places[values[k]];
    }
    std::string first = settings_.axes.empty() ? settings_.file : settings_.axes[0].place;
    for (std::size_t k = columns_.size(); k-- > 0;) {
        if (k == population_column_) continue;
        const SweepAxis& axis = settings_.axes[columns_[k].axis_index];
        first = axis.value_places[values[k]];
        for (const std::string& text : axis_overrides(axis, values[k])) {
            if (problem.find("--set '" + shortened(text) + "'") != std::string::npos) return first;
        }
    }
    return first;
}

std::vector<std::string> Sweep::overrides(std::size_t combination) const {
    const std::vector<std::size_t> values = values_of(combination);
    std::vector<std::string> texts = overrides_;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        if (k == population_column_) continue;
        for (std::string& text : axis_overrides(settings_.axes[columns_[k].axis_index], values[k])) {
            texts.push_back(std::move(text));
        }
    }
    return texts;
}

Scenario Sweep::scenario(std::size_t combination) const {
    Scenario scenario = load_scenario(settings_.scenario, overrides(combination));
    if (scenario.hash != hashes_.at(combination)) {
        throw InputError(fmt::format(
            "{}: this file, or a file that it uses, has changed while the sweep runs; start the sweep again",
            settings_.scenario));
    }
    return scenario;
}

std::string Sweep::key() const {
    std::string text = fmt::format("repetitions {}\n", settings_.repetitions);
    for (const Column& column : columns_) text += fmt::format("{}: {}\n", column.name, fmt::join(column.cells, "\n"));
    for (const std::uint64_t hash : hashes_) text += fmt::format("{:016x}\n", hash);
    return fmt::format("{:016x}", hash_of(text));
}

Shard parse_shard(const std::string& text) {
    const auto slash = text.find('/');
    const ParsedWhole index = parse_whole(text.substr(0, slash));
    const ParsedWhole count = parse_whole(slash == std::string::npos ? "" : text.substr(slash + 1));
    if (!index.problem.empty() || !count.problem.empty() || index.value < 1 || index.value > count.value ||
        count.value > kSweepPointsMax) {
        throw InputError(fmt::format("--shard: value '{}' must be K/N with K from 1 to N, such as 2/8", text));
    }
    return {static_cast<std::size_t>(index.value), static_cast<std::size_t>(count.value)};
}

}  // namespace stopline

#include "experiment/sweep.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <set>

#include <fmt/format.h>

#include "base/input_error.h"
#include "experiment/interrupted.h"
#include "experiment/program_identity.h"
#include "scenario/field_path.h"
#include "scenario/fields.h"
#include "scenario/load_scenario.h"
#include "scenario/load_sweep.h"
#include "scenario/nearest_name.h"
#include "scenario/quantity.h"

namespace stopline {

namespace {

// "km/h" as the end of a column's name: kmh; "m/s2": mps2.
std::string column_suffix(std::string_view unit_text) {
    if (unit_text.empty()) return {};
    if (unit_text == "%") return "_percent";
    if (unit_text == "km/h") return "_kmh";
    std::string suffix = "_";
    for (const char c : unit_text) suffix += c == '/' ? std::string("p") : std::string(1, c);
    return suffix;
}

// The unit of the numbers of an axis; null where its values are texts, whole numbers or lists.
const Unit* unit_of(const SweepAxis& axis) {
    const Field* const field = axis.paths.empty() ? nullptr : find_field(scenario_table(), axis.paths.front()).field;
    const auto* const number = field == nullptr ? nullptr : std::get_if<NumberField>(&field->kind);
    return number == nullptr ? nullptr : number->shown;
}

// "10 s" becomes "10" in a column of seconds. Several fields at once are represented by the first.
std::string cell_of(const SweepAxis& axis, std::size_t value, const Unit* shown) {
    const std::string override_text = axis_overrides(axis, value).front();
    const std::string text = override_text.substr(axis.paths.front().size() + 1);
    if (shown == nullptr) return text;
    const double si = parse_quantity(text, *shown).si;
    const std::string exact = exact_text(si, *shown);
    const auto space = exact.find(' ');
    const std::string number = exact.substr(0, space);
    const std::string written = space == std::string::npos ? "" : exact.substr(space + 1);
    return written == shown->text ? number : fmt::format("{}", from_si(si, *shown));
}

std::vector<std::string> names_of_populations(const Scenario& scenario) {
    std::vector<std::string> names;
    for (const PopulationSettings& population : scenario.populations) names.push_back(population.name);
    return names;
}

void require_populations(const Scenario& scenario, const std::vector<std::string>& wanted) {
    const std::vector<std::string> known = names_of_populations(scenario);
    for (const std::string& name : wanted) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        throw InputError(
            fmt::format("the scenario {} has no population '{}'{}", scenario.name, name, known_names(name, known)));
    }
}

// A setting for an axis' own field would be overwritten by it, without a word.
// The same field, or a section and something in it.
bool overlap(const std::string& a, const std::string& b) {
    const auto holds = [](const std::string& section, const std::string& path) {
        return path.rfind(section, 0) == 0 &&
               (path.size() == section.size() || path[section.size()] == '.' || path[section.size()] == '[');
    };
    return holds(a, b) || holds(b, a);
}

// One would undo what the other sets, and the table would name values that were not run.
void refuse_axes_within_axes(const SweepSettings& settings) {
    std::vector<std::pair<std::string, std::string>> before;  // path, axis
    for (const SweepAxis& axis : settings.axes) {
        for (const std::string& path : axis.paths) {
            const auto same = std::find_if(before.begin(), before.end(), [&](const auto& other) {
                return other.second != axis.name && overlap(path, other.first);
            });
            if (same != before.end()) {
                throw InputError(fmt::format("{}: the axes '{}' and '{}' both change '{}': make them one axis",
                                             settings.name, same->second, axis.name, std::max(path, same->first)));
            }
            before.emplace_back(path, axis.name);
        }
    }
}

void refuse_overridden_axes(const SweepSettings& settings, const std::vector<std::string>& overrides) {
    for (const std::string& text : overrides) {
        const std::string path = text.substr(0, text.find('='));
        for (const SweepAxis& axis : settings.axes) {
            for (const std::string& changed : axis.paths) {
                if (!overlap(path, changed)) continue;
                throw InputError(
                    fmt::format("--set '{}': '{}' is an axis of the sweep ('{}')", text, changed, axis.name));
            }
        }
    }
}

// a * b, or a number beyond any limit.
std::size_t product(std::size_t a, std::size_t b) {
    std::size_t result = 0;
    return __builtin_mul_overflow(a, b, &result) ? std::numeric_limits<std::size_t>::max() : result;
}

}  // namespace

Sweep::Sweep(SweepSettings settings, const SweepOptions& options)
    : settings_(std::move(settings)), overrides_(options.overrides) {
    refuse_axes_within_axes(settings_);
    refuse_overridden_axes(settings_, overrides_);
    base_ = load_scenario(settings_.scenario, overrides_);
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
            fmt::format("the sweep {} has more than {} runs{}: leave out values, or make several sweeps of it",
                        settings_.name, kSweepPointsMax, count));
    }
    load_combinations(combinations, options);
}

void Sweep::add_columns() {
    population_column_ = settings_.axes.size();  // behind the others where no axis picks them
    for (std::size_t k = 0; k < settings_.axes.size(); ++k) {
        const SweepAxis& axis = settings_.axes[k];
        Column column;
        column.axis = axis.name;
        column.axis_index = k;
        if (!axis.populations.empty()) {
            population_column_ = k;
            const bool all = axis.populations == std::vector<std::string>{kAllPopulations};
            column.cells = all ? names_of_populations(base_) : axis.populations;
            column.shown = column.cells;
            column.name = axis.name;
        } else {
            const Unit* const shown = unit_of(axis);
            column.name = axis.name + (shown == nullptr ? "" : column_suffix(shown->text));
            column.shown = axis.values;
            for (std::size_t i = 0; i < axis.values.size(); ++i) column.cells.push_back(cell_of(axis, i, shown));
        }
        if (std::set<std::string>(column.cells.begin(), column.cells.end()).size() < column.cells.size()) {
            throw InputError(
                fmt::format("the sweep {}: axis '{}' has the same value twice", settings_.name, axis.name));
        }
        columns_.push_back(std::move(column));
    }
    if (population_column_ < columns_.size()) return;
    const std::vector<std::string> all = names_of_populations(base_);
    columns_.push_back({"population", "population", all, all, 0});
}

void Sweep::load_combinations(std::size_t count, const SweepOptions& options) {
    hashes_.resize(count);
    std::atomic<std::size_t> loaded = 0;
    std::atomic<std::size_t> first_bad = count;
    std::atomic<bool> stopped = false;
    std::mutex mutex;
    std::exception_ptr error;
#pragma omp parallel for schedule(dynamic) num_threads(std::max(1, options.threads))
    for (std::size_t i = 0; i < count; ++i) {
        if (stopped || i > first_bad) continue;
        try {
            hashes_[i] = 0;
            const Scenario loaded_scenario = load_scenario(settings_.scenario, overrides(i));
            require_populations(loaded_scenario, columns_[population_column_].cells);
            hashes_[i] = loaded_scenario.hash;
        } catch (const InputError& bad) {
            const std::lock_guard lock(mutex);
            if (i >= first_bad) continue;
            first_bad = i;
            error = std::make_exception_ptr(
                InputError(fmt::format("the sweep {}{}: {}", settings_.name, describe_combination(i), bad.what())));
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
}

std::size_t Sweep::points() const {
    return hashes_.size() * columns_[population_column_].cells.size() * static_cast<std::size_t>(settings_.repetitions);
}

std::vector<std::string> Sweep::columns() const {
    std::vector<std::string> names;
    for (const Column& column : columns_) names.push_back(column.name);
    return names;
}

std::vector<std::size_t> Sweep::digits(std::size_t point) const {
    std::vector<std::size_t> digits(columns_.size());
    std::size_t rest = point / static_cast<std::size_t>(settings_.repetitions);
    for (std::size_t k = columns_.size(); k-- > 0;) {
        digits[k] = rest % columns_[k].cells.size();
        rest /= columns_[k].cells.size();
    }
    return digits;
}

std::vector<std::string> Sweep::cells(std::size_t point) const {
    const std::vector<std::size_t> values = digits(point);
    std::vector<std::string> cells;
    for (std::size_t k = 0; k < columns_.size(); ++k) cells.push_back(columns_[k].cells[values[k]]);
    return cells;
}

std::uint64_t Sweep::seed(std::size_t point) const {
    return base_.seed + point % static_cast<std::size_t>(settings_.repetitions);
}

std::string Sweep::population(std::size_t point) const {
    return columns_[population_column_].cells[digits(point)[population_column_]];
}

std::size_t Sweep::combination(std::size_t point) const {
    const std::vector<std::size_t> values = digits(point);
    std::size_t combination = 0;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        if (k != population_column_) combination = combination * columns_[k].cells.size() + values[k];
    }
    return combination;
}

std::string Sweep::describe(std::size_t point) const {
    const std::vector<std::size_t> values = digits(point);
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

std::vector<std::string> Sweep::overrides(std::size_t combination) const {
    std::vector<std::size_t> values(columns_.size());
    for (std::size_t k = columns_.size(); k-- > 0;) {
        if (k == population_column_) continue;
        values[k] = combination % columns_[k].cells.size();
        combination /= columns_[k].cells.size();
    }
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
            "{}: this file, or one that it names, has changed while the sweep runs; start again", settings_.scenario));
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
        throw InputError(fmt::format("--shard: '{}' is no shard: write K/N with K from 1 to N, such as 2/8", text));
    }
    return {static_cast<std::size_t>(index.value), static_cast<std::size_t>(count.value)};
}

}  // namespace stopline

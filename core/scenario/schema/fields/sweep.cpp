// Fields of a sweep file, and the checks that compare several fields of its axes.
#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "base/nearest_name.h"
#include "scenario/schema/field_path.h"
#include "scenario/schema/field_rows.h"
#include "scenario/schema/fields.h"
#include "scenario/sweep_file/load_sweep.h"

namespace stopline {
namespace {

// Names that an axis must not have, because the result table has other columns of these names
// (sweeps/sweep_results.h).
constexpr const char* kReserved[] = {"point", "seed"};

void check_paths(const SweepAxis& axis, Checker& check) {
    for (std::size_t i = 0; i < axis.paths.size(); ++i) {
        const std::string field = "path[" + std::to_string(i) + "]";
        const std::string& path = axis.paths[i];
        const FieldAtPath found = find_field(scenario_table(), path);
        if (!found.problem.empty()) {
            check.error(field, found.problem);
        } else if (path == "seed") {
            check.error(field, "seeds cannot be an axis: write 'repetitions'");
        } else if (path == "populations") {
            check.error(field, "write 'populations: [NAME, NAME]' instead of path and values");
        }
    }
}

void check_values(const SweepAxis& axis, Checker& check) {
    std::set<std::string> seen;
    for (std::size_t i = 0; i < axis.values.size(); ++i) {
        const std::string field = "values[" + std::to_string(i) + "]";
        if (!seen.insert(axis.values[i]).second) {
            check.error(field, "the value '" + shortened(axis.values[i]) + "' appears twice");
        }
        const std::size_t overrides = axis_overrides(axis, i).size();
        if (overrides != axis.paths.size()) {
            check.error(field,
                        "'" + shortened(axis.values[i]) + "' does not fit " + std::to_string(axis.paths.size()) +
                            " paths: write one value for all paths, or one value per path with '|' between them");
        }
    }
}

void check_axis(const SweepAxis& axis, Checker& check) {
    for (const char* const name : kReserved) {
        if (axis.name == name) check.error("name", "the name '" + axis.name + "' belongs to another column");
    }
    if (!axis.populations.empty()) {
        if (!axis.paths.empty() || !axis.values.empty()) {
            check.error("populations", "an axis has either populations, or a path and values");
        }
        if (std::set<std::string>(axis.populations.begin(), axis.populations.end()).size() < axis.populations.size()) {
            check.error("populations", "a population appears twice");
        }
        return;
    }
    if (axis.paths.empty()) return check.error("", "the axis needs a path and values, or populations");
    if (axis.values.empty()) return check.error("", "the axis has no values: write e.g. 'values: [5 s, 10 s]'");
    check_paths(axis, check);
    check_values(axis, check);
}

void check_sweep(const SweepSettings& sweep, Checker& check) {
    std::set<std::string> names;
    std::set<std::string> paths;
    int population_axes = 0;
    for (const SweepAxis& axis : sweep.axes) {
        const std::string field = "axes[" + axis.name + "]";
        if (!names.insert(axis.name).second) {
            check.error(field + ".name", "the name '" + axis.name + "' appears twice");
        }
        for (const std::string& path : axis.paths) {
            if (!paths.insert(current_path(scenario_table(), path)).second)
                check.error(field + ".path", "'" + path + "' is set twice");
        }
        if (!axis.populations.empty() && ++population_axes > 1) {
            check.error(field + ".populations", "only one axis may have populations");
        }
        if (axis.populations.empty() && axis.name == "population") {
            check.error(field + ".name", "the name 'population' is for an axis with populations");
        }
    }
}

const Table& axis_table() {
    using S = SweepAxis;
    static const Table table = make_table<S>(
        "an axis of the sweep: paths with values, or populations",
        {
            text<&S::name>("name", TextField::Rule::name,
                           "name of the axis; its column in the table of results has this name, followed by the unit "
                           "if there is one")
                .required(),
            texts<&S::paths>("path", TextField::Rule::title, {1, 100},
                             "path of a scenario field, such as signal.green; a list: fields that change together"),
            texts<&S::values>(
                "values", TextField::Rule::title, {1, 100'000},
                "values, written as in a scenario; with two paths, 'a | b' gives each field its own value, and "
                "a single value holds for both fields"),
            texts<&S::populations>("populations", TextField::Rule::name, {1, 1000},
                                   "names of populations of the scenario, or 'all'"),
        },
        check_axis);
    return table;
}

}  // namespace

const Table& sweep_table() {
    using S = SweepSettings;
    static const Table table = make_table<S>(
        "a sweep file",
        {
            text<&S::name>("name", TextField::Rule::name, "name of the results; default: the name of the file"),
            text<&S::title>("title", TextField::Rule::title, "heading of tables and figures"),
            text<&S::scenario>("scenario", TextField::Rule::title,
                               "scenario file, relative to the folder of the sweep file")
                .required(),
            list<&S::axes>(
                "axes", axis_table, {0, 64},
                "axes; every combination of their values is run; without an axis of populations, all populations are "
                "run"),
            whole_number<&S::repetitions>(
                "repetitions", {1, 1'000'000},
                "runs per combination; their seeds are n, n + 1, n + 2 and so on, and n is the seed of the scenario"),
        },
        check_sweep);
    return table;
}

}  // namespace stopline

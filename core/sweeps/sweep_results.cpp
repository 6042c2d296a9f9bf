#include "sweeps/sweep_results.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/input_error.h"
#include "base/io/csv.h"
#include "base/version.h"
#include "runs/tables/column_aliases.h"
#include "scenario/load_scenario.h"
#include "scenario/schema/quantity.h"

namespace stopline {

namespace {

// Calls visit(column, value) for each line "column=value" of a result text.
template <class Visit>
void for_each_value(std::string_view result, const Visit& visit) {
    while (!result.empty()) {
        const auto end = std::min(result.find('\n'), result.size());
        const std::string_view line = result.substr(0, end);
        const auto equals = std::min(line.find('='), line.size());
        visit(line.substr(0, equals), line.substr(std::min(equals + 1, line.size())));
        result.remove_prefix(std::min(end + 1, result.size()));
    }
}

// Returns a result text with the current names of its metrics. The first lines up to the seed hold axis values and are
// not changed.
std::string with_current_names(const std::string& result, OldNameReader& names) {
    std::string text;
    bool is_axis = true;
    for_each_value(result, [&](std::string_view column, std::string_view value) {
        const std::string name = is_axis ? std::string(column) : names.column(std::string(column));
        text += name + "=" + (is_axis ? std::string(value) : names.value(name, std::string(value))) + "\n";
        is_axis = is_axis && name != "seed";
    });
    return text;
}

// Appends the column names of all runs to `names`, in the order of their first appearance. Returns the index of each
// name in `names`.
std::map<std::string, std::size_t, std::less<>> columns_of(const RunStore& store, OldNameReader& old_names,
                                                           std::vector<std::string>& names) {
    std::map<std::string, std::size_t, std::less<>> index;
    store.for_each_run([&](std::size_t, const std::string& stored) {
        for_each_value(with_current_names(stored, old_names), [&](std::string_view column, std::string_view) {
            if (index.find(column) != index.end()) return;
            index.emplace(std::string(column), names.size());
            names.emplace_back(column);
        });
    });
    return index;
}

double number_of(std::string_view value) { return std::strtod(std::string(value).c_str(), nullptr); }

void add_to(SweepTotals& totals, const std::string& result) {
    const std::int64_t overlaps = count_in(result, "overlaps");
    const std::int64_t red_entries = count_in(result, "red_entries");
    const std::int64_t lost_vehicles = count_in(result, "lost_vehicles");
    const std::int64_t deadlocks = count_in(result, "deadlocks");
    bool has_junction_time = false;
    bool has_gridlocks = false;
    double from_s = 0.0;
    double warm_up_s = 0.0;
    for_each_value(result, [&](std::string_view name, std::string_view value) {
        has_gridlocks = has_gridlocks || name == "gridlocks";
        if (name == "window_from_s") from_s = number_of(value);
        if (name == "warm_up_s") warm_up_s = number_of(value);
        if (name != "longest_in_junction_s") return;
        has_junction_time = true;
        totals.longest_in_junction_s = std::max(totals.longest_in_junction_s, number_of(value));
    });
    totals.measured_in_warm_up += from_s < warm_up_s ? 1U : 0U;
    totals.starving_runs += count_in(result, "starvations") > 0 ? 1U : 0U;
    totals.with_backlog += count_in(result, "backlog") > 0 ? 1U : 0U;
    if (has_gridlocks) {
        totals.gridlocks = totals.gridlocks.value_or(0) + count_in(result, "gridlocks");
        totals.teleported += count_in(result, "teleported");
    } else if (has_junction_time) {
        totals.deadlocks = totals.deadlocks.value_or(0) + deadlocks;
    }
    ++totals.runs;
    totals.updates += count_in(result, "updates");
    totals.overlaps += overlaps;
    totals.red_entries += red_entries;
    totals.lost_vehicles += lost_vehicles;
    if (overlaps != 0 || red_entries != 0 || lost_vehicles != 0 || deadlocks != 0) ++totals.runs_with_violations;
}

}  // namespace

std::string result_text(const Sweep& sweep, std::size_t point, const std::vector<RunMetric>& metrics) {
    std::vector<std::pair<std::string, std::string>> values;
    const std::vector<std::string> columns = sweep.columns();
    const std::vector<std::string> cells = sweep.cells(point);
    for (std::size_t k = 0; k < columns.size(); ++k) values.emplace_back(columns[k], cells[k]);
    values.emplace_back("seed", fmt::format("{}", sweep.seed(point)));
    for (const RunMetric& metric : metrics) {
        if (std::find(columns.begin(), columns.end(), metric.column) != columns.end()) {
            throw InputError(
                fmt::format("the axis '{}' of the sweep {} has the name of a result column: rename the axis",
                            metric.column, sweep.settings().name));
        }
        values.emplace_back(metric.column, metric.value);
    }
    std::string text;
    for (const auto& [column, value] : values) text += column + "=" + value + "\n";
    return text;
}

std::string value_in(const std::string& result, const std::string& column) {
    std::string found;
    for_each_value(result, [&](std::string_view name, std::string_view value) {
        if (name == column) found = std::string(value);
    });
    return found;
}

std::int64_t count_in(const std::string& result, const std::string& column) {
    std::int64_t count = 0;
    for_each_value(result, [&](std::string_view name, std::string_view value) {
        if (name != column) return;
        const bool minus = value.starts_with('-');
        const ParsedWhole parsed = parse_whole(value.substr(minus ? 1 : 0));
        if (parsed.problem.empty()) count = static_cast<std::int64_t>(parsed.value) * (minus ? -1 : 1);
    });
    return count;
}

SweepTable sweep_results(const RunStore& store) {
    std::vector<std::string> names{"point"};
    OldNameReader old_names("sweep/NAME.csv");
    const auto index = columns_of(store, old_names, names);
    CsvWriter csv(names);
    SweepTable table;
    store.for_each_run([&](std::size_t point, const std::string& stored) {
        const std::string result = with_current_names(stored, old_names);
        std::vector<std::string> fields(names.size());
        fields.front() = fmt::format("{}", point);
        for_each_value(result, [&](std::string_view column, std::string_view value) {
            fields[index.find(column)->second] = std::string(value);
        });
        csv.row(fields);
        add_to(table.totals, result);
    });
    table.csv = csv.text();
    table.warnings = old_names.warnings();
    return table;
}

std::string sweep_provenance(const Sweep& sweep, const std::string& command) {
    const SweepSettings& settings = sweep.settings();
    nlohmann::ordered_json json;
    json["program"] = "stopline";
    json["version"] = version();
    json["command"] = command;
    json["sweep"] = settings.name;
    json["sweep_hash"] = sweep.key();
    json["runs"] = sweep.points();
    json["files"] = {settings.name + ".csv"};
    json["axes"] = nlohmann::ordered_json::array();
    for (const SweepAxis& axis : settings.axes) {
        nlohmann::ordered_json entry{{"name", axis.name}};
        if (axis.populations.empty()) {
            entry["path"] = axis.paths;
            entry["values"] = axis.values;
        } else {
            entry["populations"] = axis.populations;
        }
        json["axes"].push_back(std::move(entry));
    }
    json["repetitions"] = settings.repetitions;
    json["scenario"] = sweep.base().name;
    json["scenario_hash"] = fmt::format("{:016x}", sweep.base().hash);
    json["seed"] = sweep.base().seed;
    json["parameters"] = nlohmann::ordered_json::array();
    std::istringstream lines(canonical_text(sweep.base()));
    for (std::string line; std::getline(lines, line);) json["parameters"].push_back(line);
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace stopline

#include "runs/tables/column_aliases.h"

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>

#include "base/io/csv.h"

namespace stopline {

namespace {

// The old and the current name of a column. A '*' in `table` stands for any text. A '*' in `old_name` stands for any
// text, and the '*' in `name` for the same text. If several entries match a column name, the first entry applies.
struct ColumnAlias {
    std::string_view table;
    std::string_view old_name;
    std::string_view name;
};
constexpr std::array kColumns{
    ColumnAlias{"*/trajectories.csv", "place_m", "position_m"},
    ColumnAlias{"network/time_space.csv", "front_m", "position_m"},
    ColumnAlias{"network/summary.csv", "most_present", "max_present"},
    ColumnAlias{"network/*", "moved_on", "teleported"},
    ColumnAlias{"network/*", "lost_priority_h", "delay_yielding_h"},
    ColumnAlias{"network/*", "lost_start_h", "delay_queue_discharge_h"},
    ColumnAlias{"network/*", "lost_outside_h", "delay_upstream_h"},
    ColumnAlias{"network/*", "lost_*_h", "delay_*_h"},
    ColumnAlias{"network/summary.csv", "longest_stand_s", "longest_stop_s"},
    ColumnAlias{"network/summary.csv", "longest_inside_s", "longest_in_junction_s"},
    ColumnAlias{"network/summary.csv", "left", "exited"},
    ColumnAlias{"network/summary.csv", "strayed", "missed_turns"},
    ColumnAlias{"network/summary.csv", "waiting", "backlog"},
    ColumnAlias{"network/delays.csv", "most_vehicles", "max_vehicles"},
    ColumnAlias{"network/delays.csv", "lost_s", "delay_s"},
    ColumnAlias{"network/rules.csv", "stood_s", "stopped_s"},
    ColumnAlias{"network/turns.csv", "*_asked_percent", "*_target_percent"},
    ColumnAlias{"network/turns.csv", "filled_s", "congested_from_s"},
    ColumnAlias{"intersection/summary.csv", "longest_inside_s", "longest_in_junction_s"},
    ColumnAlias{"intersection/summary.csv", "lost_time_s", "startup_lost_time_s"},
    ColumnAlias{"single_light/summary.csv", "settled_vehicles_veh", "steady_vehicles"},
    ColumnAlias{"single_light/summary.csv", "settled_gap_m", "steady_net_gap_m"},
    ColumnAlias{"single_light/summary.csv", "settled_headway_s", "steady_headway_s"},
    ColumnAlias{"single_light/summary.csv", "late_line_headway_s", "last_ten_headway_s"},
    ColumnAlias{"single_light/summary.csv", "late_line_speed_mps", "last_ten_speed_mps"},
    ColumnAlias{"single_light/summary.csv", "leader_starts_s", "leader_start_s"},
    ColumnAlias{"single_light/summary.csv", "leader_to_limit_s", "leader_time_to_limit_s"},
    ColumnAlias{"single_light/summary.csv", "entered_veh", "vehicles_entered"},
    ColumnAlias{"single_light/summary.csv", "left_veh", "vehicles_exited"},
    ColumnAlias{"single_light/summary.csv", "lost_vehicles_veh", "lost_vehicles"},
    ColumnAlias{"sweep/NAME.csv", "most_present_veh", "max_present"},
    ColumnAlias{"sweep/NAME.csv", "vehicles_in_area_veh", "vehicles_in_area"},
    ColumnAlias{"sweep/NAME.csv", "vehicles_present_veh", "vehicles_present"},
    ColumnAlias{"sweep/NAME.csv", "vehicles_per_green_veh", "vehicles_per_green"},
    ColumnAlias{"sweep/NAME.csv", "vehicles_left", "vehicles_exited"},
    ColumnAlias{"sweep/NAME.csv", "waiting_veh", "backlog"},
    ColumnAlias{"sweep/NAME.csv", "moved_on", "teleported"},
    ColumnAlias{"sweep/NAME.csv", "lost_time_s", "startup_lost_time_s"},
    ColumnAlias{"sweep/NAME.csv", "lost_priority_h", "delay_yielding_h"},
    ColumnAlias{"sweep/NAME.csv", "lost_start_h", "delay_queue_discharge_h"},
    ColumnAlias{"sweep/NAME.csv", "lost_outside_h", "delay_upstream_h"},
    ColumnAlias{"sweep/NAME.csv", "lost_*_h", "delay_*_h"},
    ColumnAlias{"sweep/NAME.csv", "longest_stand_s", "longest_stop_s"},
    ColumnAlias{"sweep/NAME.csv", "longest_inside_s", "longest_in_junction_s"},
    ColumnAlias{"sweep/NAME.csv", "filled_*_s", "congested_from_*_s"},
    ColumnAlias{"sweep/NAME.csv", "changes_for_route", "mandatory_lane_changes"},
    ColumnAlias{"sweep/NAME.csv", "changes_for_speed", "discretionary_lane_changes"},
    ColumnAlias{"sweep/NAME.csv", "emptied_s", "queue_emptied_s"},
    ColumnAlias{"sweep/NAME.csv", "settled_veh", "steady_vehicles"},
    ColumnAlias{"sweep/NAME.csv", "settled_headway_s", "steady_headway_s"},
    ColumnAlias{"sweep/NAME.csv", "settled_net_gap_m", "steady_net_gap_m"},
    ColumnAlias{"sweep/NAME_means.csv", "low", "ci95_low"},
    ColumnAlias{"sweep/NAME_means.csv", "high", "ci95_high"},
    ColumnAlias{"sweep/NAME_means.csv", "difference_low", "difference_ci95_low"},
    ColumnAlias{"sweep/NAME_means.csv", "difference_high", "difference_ci95_high"},
    ColumnAlias{"calibrate/permutations.csv", "within_percent", "within_limit_percent"},
    ColumnAlias{"calibrate/permutations.csv", "median_s", "median_difference_s"},
    ColumnAlias{"calibrate/permutations.csv", "p95_s", "p95_difference_s"},
    ColumnAlias{"calibrate/permutations.csv", "largest_s", "largest_difference_s"},
    ColumnAlias{"calibrate/permutations.csv", "other_green", "pairs_in_other_green"},
    ColumnAlias{"calibrate/fit_history.csv", "leader_acceleration_until", "leader_constant_power_speed"},
    ColumnAlias{"calibrate/fit_history.csv", "*.acceleration_until", "*.constant_power_speed"},
    ColumnAlias{"calibrate/fit_history.csv", "*.catch_up", "*.catch_up_factor"},
    ColumnAlias{"calibrate/fit_history.csv", "below_band", "below_band_speed_share"},
    ColumnAlias{"startup/startup.csv", "low_2.5_kmh", "p2.5_kmh"},
    ColumnAlias{"startup/startup.csv", "high_97.5_kmh", "p97.5_kmh"},
    ColumnAlias{"data/paper/quick.csv", "what", "applies_to"},
    ColumnAlias{"data/paper/explanations.csv", "counted", "measured_as"},
};

// The old and the current form of a cell value.
struct ValueAlias {
    std::string_view table;
    std::string_view column;
    std::string_view old_value;
    std::string_view value;
};
constexpr std::array kValues{
    ValueAlias{"network/delays.csv", "cause", "priority", "yielding"},
    ValueAlias{"network/delays.csv", "cause", "start", "queue_discharge"},
    ValueAlias{"network/rules.csv", "rule", "moved_on", "teleported"},
    ValueAlias{"network/rules.csv", "rule", "put_back", "reinserted"},
    ValueAlias{"network/rules.csv", "rule", "kept_out", "keep_clear"},
    ValueAlias{"network/summary.csv", "unstable_by", "fall", "throughput_drop"},
    ValueAlias{"network/summary.csv", "unstable_by", "moved_on", "teleported"},
    ValueAlias{"sweep/NAME.csv", "unstable_by", "fall", "throughput_drop"},
    ValueAlias{"sweep/NAME.csv", "unstable_by", "moved_on", "teleported"},
    ValueAlias{"compare/comparison.csv", "metric", "standing_vehicles", "stopped_vehicles"},
    ValueAlias{"compare/comparison.csv", "metric", "wait_outside_s", "departure_delay_s"},
    ValueAlias{"compare/comparison.csv", "metric", "waiting_at_end_veh", "backlog"},
    ValueAlias{"compare/comparison.csv", "metric", "moved_on_veh", "teleported"},
};

// The old file name of a table.
struct FileAlias {
    std::string_view table;
    std::string_view old_file;
};
constexpr std::array kFiles{
    FileAlias{"network/origin_destination.csv", "ways.csv"},
    FileAlias{"network/delays.csv", "hindrance.csv"},
};

constexpr std::string_view kSweepTable = "sweep/NAME.csv";
constexpr std::string_view kMeansTable = "sweep/NAME_means.csv";
constexpr std::string_view kBandsTable = "calibrate/bands_NAME.csv";

// Returns the part of `text` at the place of the '*' in `pattern`; "" if the pattern has no '*'. Returns std::nullopt
// if the text does not match the pattern.
std::optional<std::string_view> match(std::string_view pattern, std::string_view text) {
    const std::size_t star = pattern.find('*');
    if (star == std::string_view::npos) return pattern == text ? std::optional(std::string_view()) : std::nullopt;
    const std::string_view begin = pattern.substr(0, star);
    const std::string_view end = pattern.substr(star + 1);
    if (text.size() <= begin.size() + end.size() || !text.starts_with(begin) || !text.ends_with(end)) {
        return std::nullopt;
    }
    return text.substr(begin.size(), text.size() - begin.size() - end.size());
}

std::string filled(std::string_view pattern, std::string_view text) {
    std::string name(pattern);
    const std::size_t star = name.find('*');
    if (star != std::string::npos) name.replace(star, 1, text);
    return name;
}

// Translates a column name from the old to the current name (`from` is old_name, `to` is name) or back (`from` is name,
// `to` is old_name). Returns a name without an entry in kColumns unchanged.
std::string renamed_column(std::string_view table, const std::string& name, std::string_view ColumnAlias::*from,
                           std::string_view ColumnAlias::*to) {
    for (const ColumnAlias& alias : kColumns) {
        if (!match(alias.table, table)) continue;
        if (const auto text = match(alias.*from, name)) return filled(alias.*to, *text);
    }
    return name;
}

std::string renamed_value(std::string_view table, std::string_view column, const std::string& value,
                          std::string_view ValueAlias::*from, std::string_view ValueAlias::*to) {
    for (const ValueAlias& alias : kValues) {
        if (alias.table == table && alias.column == column && alias.*from == value) return std::string(alias.*to);
    }
    return value;
}

// Returns the index of the first column that can have an old name. In tables of sweeps and of their means, this is the
// column `seed` or `metric`: most columns before this column are axes, whose names the user chooses. In all other
// tables the index is 0.
std::size_t first_result_column(std::string_view table, const std::vector<std::string>& columns) {
    const char* const last_axis = table == kSweepTable ? "seed" : "metric";
    if (table != kSweepTable && table != kMeansTable) return 0;
    return static_cast<std::size_t>(std::find(columns.begin(), columns.end(), last_axis) - columns.begin());
}

std::string old_value(std::string_view table, const std::string& column, const std::string& value) {
    // In the tables of means and of bands, a cell of the column 'metric' contains the name of a column of the sweep
    // table. The cell is translated like that column name.
    if ((table == kMeansTable || table == kBandsTable) && column == "metric") {
        return renamed_column(kSweepTable, value, &ColumnAlias::name, &ColumnAlias::old_name);
    }
    return renamed_value(table, column, value, &ValueAlias::value, &ValueAlias::old_value);
}

}  // namespace

std::string OldNameReader::column(const std::string& name) {
    const auto [found, is_new] = known_.try_emplace(name, name);
    if (is_new) {
        found->second = renamed_column(table_, name, &ColumnAlias::old_name, &ColumnAlias::name);
        if (found->second != name) {
            warnings_.push_back(
                fmt::format("column '{}' is now called '{}'; the old name will be removed in the next release", name,
                            found->second));
        }
    }
    return found->second;
}

std::string OldNameReader::value(const std::string& column, const std::string& value) {
    return renamed_value(table_, column, value, &ValueAlias::old_value, &ValueAlias::value);
}

std::vector<std::string> use_current_column_names(std::string_view name, CsvTable& table) {
    OldNameReader old_names{std::string(name)};
    for (std::string& column : table.columns) column = old_names.column(column);
    std::vector<std::string> warnings;
    for (const std::string& warning : old_names.warnings()) warnings.push_back(table.label + ": " + warning);
    return warnings;
}

std::string with_old_names(std::string_view table, const std::string& csv) {
    const CsvTable current = parse_csv(csv, std::string(table));
    std::vector<std::string> columns = current.columns;
    const std::size_t first = first_result_column(table, columns);
    for (std::size_t k = first; k < columns.size(); ++k) {
        columns[k] = renamed_column(table, columns[k], &ColumnAlias::name, &ColumnAlias::old_name);
    }
    CsvWriter old(columns);
    for (std::vector<std::string> row : current.rows) {
        for (std::size_t k = first; k < row.size(); ++k) row[k] = old_value(table, current.columns[k], row[k]);
        old.row(row);
    }
    return old.text();
}

std::string result_file_name(std::string_view table, std::string file, ColumnNames names) {
    const auto found =
        std::find_if(kFiles.begin(), kFiles.end(), [&](const FileAlias& alias) { return alias.table == table; });
    if (names == ColumnNames::old && found != kFiles.end()) file = found->old_file;
    return file;
}

ResultFile result_file(std::string_view table, std::string file, std::string csv, ColumnNames names) {
    file = result_file_name(table, std::move(file), names);
    return {std::move(file), names == ColumnNames::current ? std::move(csv) : with_old_names(table, csv)};
}

std::string old_names_markdown() {
    std::string text =
        "## Old names\n\n"
        "The last release used other names. With `--old-column-names`, these programs write them: `stopline-run`,\n"
        "`stopline-sweep`, `stopline-startup`, `stopline-calibrate` and `stopline-compare`. The programs also read\n"
        "tables of `data/paper` with old names. The next release knows only the new names. `*` stands for any text.\n\n"
        "| table | column | old name |\n|---|---|---|\n";
    for (const ColumnAlias& alias : kColumns) {
        text += fmt::format("| {} | `{}` | `{}` |\n", alias.table, alias.name, alias.old_name);
    }
    text += "\n| table | column | value | old value |\n|---|---|---|---|\n";
    for (const ValueAlias& alias : kValues) {
        text += fmt::format("| {} | `{}` | `{}` | `{}` |\n", alias.table, alias.column, alias.value, alias.old_value);
    }
    text += "\n| file | old file |\n|---|---|\n";
    for (const FileAlias& alias : kFiles) text += fmt::format("| {} | {} |\n", alias.table, alias.old_file);
    return text;
}

}  // namespace stopline

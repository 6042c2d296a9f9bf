#include "scenario/demand/traffic_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "base/io/csv.h"
#include "base/nearest_name.h"
#include "base/text_hash.h"
#include "demand/route_search.h"
#include "demand/traffic_table.h"
#include "scenario/demand/plan_arrivals.h"
#include "scenario/kinds/network_kind.h"

namespace stopline {

namespace {

constexpr double kMaxTime_s = 1e6;
constexpr std::int64_t kMaxVehicles = 1'000'000;  // in one row
constexpr std::array<const char*, 3> kTurnNames{"left", "straight", "right"};
constexpr std::array<Turn, 3> kTurnsOfColumns{Turn::left, Turn::straight, Turn::right};

std::vector<std::string> known_columns(bool is_matrix) {
    if (is_matrix) return {"begin", "end", "origin", "destination", "vehicles"};
    return {"begin", "end", "approach", "vehicles", "left", "straight", "right"};
}

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t");
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// Reads the rows of a traffic file. Collects the problems of all rows.
class TrafficReader {
public:
    TrafficReader(const Scenario& scenario, CsvTable csv)
        : csv_(std::move(csv)),
          graph_(graph_of(scenario)),
          is_matrix_(scenario.demand.kind == "od"),
          duration_s_(scenario.duration_s) {
        entries_ = entry_legs(graph_);
        exits_ = exit_legs(graph_);
        find_columns();
    }

    std::vector<TrafficRow> read() {
        std::vector<TrafficRow> rows;
        if (!problems_.empty()) return rows;
        for (std::size_t k = 0; k < csv_.rows.size(); ++k) {
            const std::size_t problems = problems_.size();
            TrafficRow row = read_row(k);
            if (problems_.size() != problems) continue;
            check_turns(k, row);
            check_way(k, row);
            rows.push_back(std::move(row));
            lines_.push_back(csv_.lines[k]);
        }
        if (csv_.rows.empty()) add_problem(1, "", "the file has no row below its header");
        if (problems_.empty()) check_intervals(rows);
        if (problems_.empty()) check_duration(rows);
        std::stable_sort(rows.begin(), rows.end(),
                         [](const TrafficRow& a, const TrafficRow& b) { return a.from_s < b.from_s; });
        return rows;
    }

    const std::vector<std::string>& problems() const { return problems_; }

private:
    static LaneGraph graph_of(const Scenario& scenario) {
        LaneGraph graph = network_kind(scenario.network).graph(scenario.network);
        if (scenario.demand.kind == "od") add_approaches(graph);
        return graph;
    }

    // A run without a vehicle of the file is a mistake, such as times of day instead of times of the run.
    void check_duration(const std::vector<TrafficRow>& rows) {
        const auto is_late = [&](const TrafficRow& row) { return row.from_s >= duration_s_; };
        if (duration_s_ <= 0.0 || !std::all_of(rows.begin(), rows.end(), is_late)) return;
        add_problem(std::size_t{0}, "begin",
                    fmt::format("value {}: all rows begin at or after the end of the run, {:g} s",
                                csv_.rows.front()[csv_.column("begin")], duration_s_));
    }

    void add_problem(int line, const std::string& place, const std::string& text) {
        problems_.push_back(fmt::format("{}:{}:{} {}", csv_.label, line, place, text));
    }
    // Adds a problem of a cell. Its place is the line and the first character of the cell.
    void add_problem(std::size_t row, const std::string& column, const std::string& text) {
        std::size_t character = 1;
        for (std::size_t k = 0; k < columns_.at(column); ++k) character += csv_.rows[row][k].size() + 1;
        add_problem(csv_.lines[row], fmt::format("{}:", character), fmt::format("{}: {}", column, text));
    }

    void find_columns() {
        const std::vector<std::string> known = known_columns(is_matrix_);
        for (std::size_t k = 0; k < csv_.columns.size(); ++k) {
            const std::string name = trimmed(csv_.columns[k]);
            if (std::find(known.begin(), known.end(), name) == known.end()) {
                add_problem(1, "",
                            fmt::format("unknown column '{}'{}", shortened(name), known_names_hint(name, known)));
            } else if (!columns_.emplace(name, k).second) {
                add_problem(1, "", fmt::format("column '{}' appears twice", name));
            }
        }
        const auto turns = std::count_if(kTurnNames.begin(), kTurnNames.end(),
                                         [&](const char* name) { return columns_.contains(name); });
        for (const std::string& name : known) {
            const bool is_turn = std::find(kTurnNames.begin(), kTurnNames.end(), name) != kTurnNames.end();
            if (columns_.contains(name) || (is_turn && turns == 0)) continue;
            const std::string reason = is_turn ? " (left, straight and right belong together)" : "";
            add_problem(1, "", fmt::format("there is no column '{}'{}", name, reason));
        }
        has_turns_ = turns > 0;
    }

    std::string cell(std::size_t row, const std::string& column) const {
        return trimmed(csv_.rows[row][columns_.at(column)]);
    }

    double read_time(std::size_t row, const std::string& column) {
        const std::string text = cell(row, column);
        const std::optional<double> value = parse_number(text);
        if (value && *value >= 0.0 && *value <= kMaxTime_s) return *value;
        add_problem(row, column,
                    fmt::format("value '{}' is not a time: a number from 0 to {:g}, in seconds since the "
                                "start of the run",
                                shortened(text), kMaxTime_s));
        return 0.0;
    }

    std::int64_t read_count(std::size_t row, const std::string& column) {
        const std::string text = cell(row, column);
        const std::optional<double> value = parse_number(text);
        if (value && *value >= 0.0 && *value <= static_cast<double>(kMaxVehicles) && *value == std::floor(*value)) {
            return static_cast<std::int64_t>(*value);
        }
        add_problem(row, column,
                    fmt::format("value '{}' is not a number of vehicles: a whole number from 0 to {}", shortened(text),
                                kMaxVehicles));
        return 0;
    }

    std::string read_leg(std::size_t row, const std::string& column, const std::vector<std::string>& known,
                         const std::string& role) {
        constexpr std::size_t kListedMax = 12;
        std::string name = cell(row, column);
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            add_problem(row, column,
                        fmt::format("vehicles do not {} the network at '{}'{}", role, shortened(name),
                                    known_names_hint(name, known, kListedMax)));
        }
        return name;
    }

    TrafficRow read_row(std::size_t k) {
        TrafficRow row;
        row.from_s = read_time(k, "begin");
        row.to_s = read_time(k, "end");
        if (row.to_s <= row.from_s) {
            add_problem(k, "end", fmt::format("value {:g} must be above begin = {:g}", row.to_s, row.from_s));
        }
        row.origin = read_leg(k, is_matrix_ ? "origin" : "approach", entries_, "enter");
        if (is_matrix_) row.destination = read_leg(k, "destination", exits_, "leave");
        row.vehicles = read_count(k, "vehicles");
        if (has_turns_) {
            row.turns.emplace();
            for (std::size_t turn = 0; turn < kTurnNames.size(); ++turn) {
                (*row.turns)[turn] = read_count(k, kTurnNames[turn]);
            }
        }
        return row;
    }

    void check_turns(std::size_t k, const TrafficRow& row) {
        if (!row.turns) return;
        std::int64_t sum = 0;
        for (std::size_t turn = 0; turn < kTurnNames.size(); ++turn) {
            sum += (*row.turns)[turn];
            if ((*row.turns)[turn] == 0 || allows(row.origin, kTurnsOfColumns[turn])) continue;
            add_problem(k, kTurnNames[turn],
                        fmt::format("value {}: no lane of '{}' allows this movement", (*row.turns)[turn], row.origin));
        }
        if (sum == row.vehicles) return;
        add_problem(k, "vehicles", fmt::format("value {} is not left + straight + right = {}", row.vehicles, sum));
    }

    // Returns true if a route with the turn begins on a lane of the leg, turn pockets included.
    bool allows(const std::string& leg, Turn turn) const {
        return std::any_of(graph_.routes.begin(), graph_.routes.end(), [&](const Route& route) {
            return leg_name(graph_.lanes[at(route.lanes[0])].name) == leg &&
                   graph_.lanes[at(route.lanes[1])].turn == turn;
        });
    }

    void check_way(std::size_t k, const TrafficRow& row) {
        if (!is_matrix_) return;
        auto paths = paths_from_.find(row.origin);
        if (paths == paths_from_.end()) {
            const auto entry = std::find_if(graph_.entries.begin(), graph_.entries.end(), [&](int lane) {
                return leg_name(graph_.lanes[at(lane)].name) == row.origin;
            });
            const int approach = graph_.lanes[at(*entry)].approach;
            paths = paths_from_.try_emplace(row.origin, graph_, approach).first;
        }
        if (paths->second.to(row.destination)) return;
        add_problem(k, "destination", fmt::format("no path leads from '{}' to '{}'", row.origin, row.destination));
    }

    // Checks the intervals of each approach, or of each pair of origin and destination: they must follow each other
    // without gap or overlap. Approaches and pairs of the same file must cover the same time.
    void check_intervals(const std::vector<TrafficRow>& rows) {
        std::map<std::string, std::vector<std::size_t>> series;
        double first_s = kMaxTime_s;
        double last_s = 0.0;
        for (std::size_t k = 0; k < rows.size(); ++k) {
            series[series_name(rows[k])].push_back(k);
            first_s = std::min(first_s, rows[k].from_s);
            last_s = std::max(last_s, rows[k].to_s);
        }
        for (auto& [name, members] : series) {
            std::stable_sort(members.begin(), members.end(),
                             [&](std::size_t a, std::size_t b) { return rows[a].from_s < rows[b].from_s; });
            double reached_s = first_s;
            for (const std::size_t k : members) {
                const TrafficRow& row = rows[k];
                if (row.from_s < reached_s) {
                    add_problem(lines_[k], "",
                                fmt::format("the interval {:g} to {:g} s of {} overlaps another one", row.from_s,
                                            row.to_s, name));
                } else if (row.from_s > reached_s) {
                    add_problem(lines_[k], "",
                                fmt::format("the interval {:g} to {:g} s of {} is missing before this "
                                            "line (write a row with 0 vehicles if there are none)",
                                            reached_s, row.from_s, name));
                }
                reached_s = std::max(reached_s, row.to_s);
            }
            if (reached_s < last_s) {
                add_problem(
                    lines_[members.back()], "",
                    fmt::format("the interval {:g} to {:g} s of {} is missing after this line (write a row with "
                                "0 vehicles if there are none)",
                                reached_s, last_s, name));
            }
        }
        check_shared_intervals(rows);
    }

    // Pairs with the same origin must have the same intervals, because their vehicles share the lanes of the origin.
    void check_shared_intervals(const std::vector<TrafficRow>& rows) {
        std::map<std::pair<std::string, double>, std::size_t> first_row;
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const std::size_t other = first_row.try_emplace({rows[k].origin, rows[k].from_s}, k).first->second;
            if (rows[other].to_s == rows[k].to_s) continue;
            add_problem(lines_[k], "",
                        fmt::format("the interval {:g} to {:g} s of origin '{}' overlaps the interval "
                                    "{:g} to {:g} s of line {}: rows with the same origin must have the same intervals",
                                    rows[k].from_s, rows[k].to_s, rows[k].origin, rows[other].from_s, rows[other].to_s,
                                    lines_[other]));
        }
    }

    std::string series_name(const TrafficRow& row) const {
        return is_matrix_ ? fmt::format("'{}' to '{}'", row.origin, row.destination)
                          : fmt::format("approach '{}'", row.origin);
    }

    CsvTable csv_;
    LaneGraph graph_;
    bool is_matrix_ = false;
    double duration_s_ = 0.0;
    bool has_turns_ = false;
    std::vector<std::string> entries_;
    std::vector<std::string> exits_;
    std::map<std::string, std::size_t> columns_;  // [name] index in the file
    std::map<std::string, ShortestPaths> paths_from_;
    std::vector<int> lines_;  // [row without problems] line in the file
    std::vector<std::string> problems_;
};

}  // namespace

std::vector<FieldProblem> read_traffic_file(Scenario& scenario, const std::filesystem::path& directory) {
    constexpr std::size_t kReportedMax = 10;
    const bool is_matrix = scenario.demand.kind == "od";
    if (!is_matrix && scenario.demand.kind != "counts") return {};
    const std::string field = is_matrix ? "demand.od" : "demand.counts";
    const std::filesystem::path file =
        (directory / (is_matrix ? scenario.demand.od : scenario.demand.counts)).lexically_normal();
    const std::string label = file.generic_string();
    std::ifstream in(file, std::ios::binary);
    if (!in || std::filesystem::is_directory(file)) {
        return {{field, label + ": the file does not exist or cannot be read"}};
    }
    std::ostringstream content;
    const bool is_empty = in.peek() == std::ifstream::traits_type::eof() && !in.bad();
    if (!is_empty && !(content << in.rdbuf())) return {{field, label + ": the file cannot be read"}};
    const std::string text = content.str();
    std::vector<FieldProblem> problems;
    try {
        TrafficReader reader(scenario, parse_csv(text, label));
        auto table = std::make_shared<TrafficTable>(TrafficTable{reader.read(), hash_of(text)});
        for (const std::string& problem : reader.problems()) {
            if (problems.size() < kReportedMax) problems.emplace_back(field, problem);
        }
        scenario.demand.table = std::move(table);
    } catch (const InputError& error) {
        problems.emplace_back(field, error.what());
    }
    return problems;
}

std::uint64_t traffic_file_hash(const Scenario& scenario) {
    return scenario.demand.table == nullptr ? 0 : scenario.demand.table->hash;
}

}  // namespace stopline

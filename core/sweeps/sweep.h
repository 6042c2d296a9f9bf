// The runs of a sweep. Each run has a number from 0, called its point. The axis values and the seed of a run follow
// from its point alone. So shards, threads and machines need no communication, and no list of runs is kept in memory.
//
// There is one point for each combination of axis values and seed. In the order of the points, the seed varies fastest,
// then the last axis of the sweep file. The first axis varies slowest. If no axis selects populations, the populations
// are an additional last axis.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scenario/scenario.h"
#include "scenario/sweep_file/sweep_settings.h"

namespace stopline {

inline constexpr std::size_t kSweepPointsMax = 10'000'000;

// Maps an axis value, given by column name and cell, to its title in figures, such as "turns 5 % / 10 %".
using CellTitles = std::map<std::pair<std::string, std::string>, std::string>;

struct SweepOptions {
    std::vector<std::string> overrides;  // from --set, applied before the axis values
    int threads = 1;
    // Receives the loaded share of the combinations, 0..1. Loading stops if the function returns false.
    std::function<bool(double)> on_progress;
};

class Sweep {
public:
    // Checks every combination of axis values before the first run, by loading the scenario with these values. Throws
    // InputError that names the axis values of the first invalid combination. Throws Interrupted if on_progress returns
    // false.
    explicit Sweep(SweepSettings settings, const SweepOptions& options = {});

    const SweepSettings& settings() const { return settings_; }
    const Scenario& base() const { return base_; }  // the scenario without axis values
    // Returns the warnings from loading the sweep file and all combinations, one line each, without repetitions.
    const std::vector<std::string>& warnings() const { return warnings_; }
    std::size_t points() const;  // number of runs
    // Returns the number of combinations of axis values. Populations and seeds are not counted.
    std::size_t combinations() const { return hashes_.size(); }

    // Returns the names of the columns with axis values. A name ends with the unit of the values, such as "green_s".
    std::vector<std::string> columns() const;
    // Returns the axis values of a point, one for each column.
    std::vector<std::string> cells(std::size_t point) const;
    // Returns the name of the column with the populations, which is the name of their axis in the sweep file.
    const std::string& population_column() const { return columns_[population_column_].name; }
    CellTitles titles() const;
    std::uint64_t seed(std::size_t point) const;
    std::string population(std::size_t point) const;
    std::size_t combination(std::size_t point) const;

    // Returns the axis values and the seed as text, such as "green = 5 s, population = CDG, seed = 1".
    std::string describe(std::size_t point) const;

    // Loads the scenario with a combination of axis values. Throws InputError if the files of the scenario have changed
    // since the constructor loaded them.
    Scenario scenario(std::size_t combination) const;

    // Returns a hash of the scenarios of all combinations, the axis values and the number of seeds. Sweeps with the
    // same key have the same results if the same program runs them.
    std::string key() const;

private:
    struct Column {
        std::string name;
        std::string axis;                 // name of the axis in the sweep file
        std::vector<std::string> cells;   // [value] text in the result table
        std::vector<std::string> shown;   // [value] text in the sweep file
        std::vector<std::string> titles;  // [value] text in figures
        std::size_t axis_index = 0;       // index into settings().axes; not valid for populations without an axis
    };

    std::vector<std::size_t> value_indices(std::size_t point) const;  // [column] index of the axis value
    std::vector<std::string> overrides(std::size_t combination) const;
    std::string describe_combination(std::size_t combination) const;
    // Returns, for each column, the index of its value in a combination. For the column of populations the index is 0.
    std::vector<std::size_t> values_of(std::size_t combination) const;
    // Returns the place in the sweep file of the axis value that causes the error `problem` in a combination: the value
    // with which loading fails even without the other axes, else the value that the message quotes, else the value of
    // the first axis.
    std::string place_of_problem(std::size_t combination, const std::string& problem) const;
    // Returns the place of the population that `problem` names as unknown; "" if it names none.
    std::string place_of_population(const std::string& problem) const;
    // Returns true if the scenario cannot be loaded with this axis value and without the other axes.
    bool fails_alone(const SweepAxis& axis, std::size_t value) const;
    void add_columns();
    void check_column_names(std::set<std::string> taken) const;
    void load_combinations(std::size_t count, const SweepOptions& options);
    void add_warnings(const std::vector<std::string>& warnings);

    SweepSettings settings_;
    std::vector<std::string> overrides_;
    std::vector<std::string> warnings_;
    Scenario base_;
    std::vector<Column> columns_;
    std::size_t population_column_ = 0;
    std::vector<std::uint64_t> hashes_;  // [combination] Scenario::hash
};

// One of `count` parts of a sweep; `index` counts from 1. Of every `count` successive points, each shard gets one. The
// order of the shards shifts from one such group of points to the next. In a fixed order, a shard could get the same
// axis value every time, and thus more work than the other shards.
struct Shard {
    std::size_t index = 1;
    std::size_t count = 1;
    // Returns true if the shard contains the point.
    bool has(std::size_t point) const { return (point + point / count) % count == index - 1; }
};
// Parses a shard such as "2/8". Throws InputError if the text has another form.
Shard parse_shard(const std::string& text);

}  // namespace stopline

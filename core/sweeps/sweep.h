// The runs of a sweep. Each run is identified by its number, the point. The axis values and the seed follow from the
// point alone, so shards, threads and machines agree without communication, and no list of runs is kept in memory.
//
// Points count through the axes in the order of the file, the last axis fastest. If no axis selects populations, they
// are the last axis. Repetitions vary fastest of all.
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

// Titles of axis values for figures, by column and cell, such as "turns 5 % / 10 %".
using CellTitles = std::map<std::pair<std::string, std::string>, std::string>;

struct SweepOptions {
    std::vector<std::string> overrides;  // of --set; axes are applied after them
    int threads = 1;
    std::function<bool(double)> on_progress;  // see RunAllOptions
};

class Sweep {
public:
    // Loads and checks every combination of values. Throws InputError with the values of the first bad combination.
    explicit Sweep(SweepSettings settings, const SweepOptions& options = {});

    const SweepSettings& settings() const { return settings_; }
    const Scenario& base() const { return base_; }  // without axis values
    // Warnings of loading the sweep file and all combinations, one line each, without repetitions.
    const std::vector<std::string>& warnings() const { return warnings_; }
    std::size_t points() const;
    std::size_t combinations() const { return hashes_.size(); }  // without populations and seeds

    // Returns the columns of the axes. A name ends with the unit of the axis.
    std::vector<std::string> columns() const;
    // Returns the axis values of a point, one for each column.
    std::vector<std::string> cells(std::size_t point) const;
    // Returns the column of the populations. The sweep file chooses the name of the axis.
    const std::string& population_column() const { return columns_[population_column_].name; }
    CellTitles titles() const;
    std::uint64_t seed(std::size_t point) const;
    std::string population(std::size_t point) const;
    std::size_t combination(std::size_t point) const;

    // Returns a text such as "green = 5 s, population = CDG, seed = 1".
    std::string describe(std::size_t point) const;

    // Loads the scenario of a combination again. Throws InputError if its files have changed since the sweep was
    // loaded.
    Scenario scenario(std::size_t combination) const;

    // Returns a hash of everything that the results depend on, except the program: scenarios, axes and seeds.
    std::string key() const;

private:
    struct Column {
        std::string name;
        std::string axis;                 // name of the axis
        std::vector<std::string> cells;   // [value] as in the result table
        std::vector<std::string> shown;   // [value] as in the sweep file
        std::vector<std::string> titles;  // [value] for figures
        std::size_t axis_index = 0;       // index into settings().axes; unused for populations
    };

    std::vector<std::size_t> value_indices(std::size_t point) const;  // [column]
    std::vector<std::string> overrides(std::size_t combination) const;
    std::string describe_combination(std::size_t combination) const;
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
    std::vector<std::uint64_t> hashes_;  // [combination] scenario hash
};

// Selects the points of shard `index` (from 1) of `count`. Each shard has one of every `count` successive points, at a
// shifting place. At a fixed place, shards could get different axis values and so unequal work.
struct Shard {
    std::size_t index = 1;
    std::size_t count = 1;
    bool has(std::size_t point) const { return (point + point / count) % count == index - 1; }
};
// Parses "K/N". Throws InputError.
Shard parse_shard(const std::string& text);

}  // namespace stopline

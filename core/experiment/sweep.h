// The runs of a sweep. A run is known by its number, a point: which value of each axis and which seed it has follows from the
// number alone, so that shards, threads and machines agree without talking, and no list of runs lies in memory.
//
// Points count through the axes in the order of the file, the last one fastest; populations come last where no axis picks
// them; repetitions run fastest of all.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scenario/scenario.h"
#include "scenario/sweep_settings.h"

namespace stopline {

inline constexpr std::size_t kSweepPointsMax = 10'000'000;

// Words for what stands in the table of results, by column and cell: "turns 5 % / 10 %".
using CellTitles = std::map<std::pair<std::string, std::string>, std::string>;

struct SweepOptions {
    std::vector<std::string> overrides;  // --set, before the axes
    int threads = 1;
    std::function<bool(double)> on_progress;  // see RunAllOptions
};

class Sweep {
public:
    // Loads and checks every combination of values. Throws InputError that names the values where one cannot be used.
    explicit Sweep(SweepSettings settings, const SweepOptions& options = {});

    const SweepSettings& settings() const { return settings_; }
    const Scenario& base() const { return base_; }  // without any axis
    std::size_t points() const;
    std::size_t combinations() const { return hashes_.size(); }  // scenarios, populations and seeds apart

    // Names of the axes with their units, as columns, and the values of a point in them.
    std::vector<std::string> columns() const;
    std::vector<std::string> cells(std::size_t point) const;
    // The column of the populations, whatever their axis is called.
    const std::string& population_column() const { return columns_[population_column_].name; }
    CellTitles titles() const;
    std::uint64_t seed(std::size_t point) const;
    std::string population(std::size_t point) const;
    std::size_t combination(std::size_t point) const;

    // "green = 5 s, population = CDG, seed = 1"
    std::string describe(std::size_t point) const;

    // The scenario of a combination. It is read from the files again; throws InputError where they have changed meanwhile.
    Scenario scenario(std::size_t combination) const;

    // Of everything that the results depend on but the program: the text of all scenarios, the axes, the seeds.
    std::string key() const;

private:
    struct Column {
        std::string name;
        std::string axis;                 // its name
        std::vector<std::string> cells;   // [value], as in the table of results
        std::vector<std::string> shown;   // [value], as the user wrote it
        std::vector<std::string> titles;  // [value], in words
        std::size_t axis_index = 0;       // in the settings; not used where the values are populations
    };

    std::vector<std::size_t> digits(std::size_t point) const;  // [column], index of the value
    std::vector<std::string> overrides(std::size_t combination) const;
    std::string describe_combination(std::size_t combination) const;
    void add_columns();
    void refuse_names_of(std::set<std::string> taken) const;
    void load_combinations(std::size_t count, const SweepOptions& options);

    SweepSettings settings_;
    std::vector<std::string> overrides_;
    Scenario base_;
    std::vector<Column> columns_;
    std::size_t population_column_ = 0;
    std::vector<std::uint64_t> hashes_;  // [combination], of the scenario
};

// Points of shard `index` (from 1) of `count`. Of every `count` successive points each shard has one, and another one each time:
// were it the same one, a shard count that divides an axis' size would give each shard values of its own, and other work.
struct Shard {
    std::size_t index = 1;
    std::size_t count = 1;
    bool has(std::size_t point) const { return (point + point / count) % count == index - 1; }
};
// From "K/N"; throws InputError.
Shard parse_shard(const std::string& text);

}  // namespace stopline

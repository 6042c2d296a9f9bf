// What a first look leaves out of the paper's experiments, as a table that anybody can read and change: data/paper/quick.csv, columns
// what,field,value. `what` is sweeps/NAME or scenarios/NAME; `field` is
//     repetitions   seeds of each combination
//     axis NAME     the values of that axis that are kept, separated by ';'
//     PATH          a field of the scenario, as for --set
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenario/sweep_settings.h"

namespace stopline {

class Reductions {
public:
    struct Row {
        std::string what;
        std::string field;
        std::string value;
    };

    Reductions() = default;  // leaves nothing out
    // Throws InputError where the file cannot be read or a row cannot be understood.
    static Reductions load(const std::filesystem::path& file);

    const std::vector<Row>& rows() const { return rows_; }

    // Overrides for load_scenario.
    std::vector<std::string> settings(const std::string& what) const;
    std::optional<int> repetitions(const std::string& what) const;
    // Keeps the values and repetitions of sweeps/NAME. Throws InputError for an axis or a value that the sweep does not have.
    void apply(SweepSettings& sweep) const;

private:
    std::vector<Row> rows_;
};

}  // namespace stopline

// Reductions make the paper's experiments shorter for a quick run. Users can edit them in data/paper/quick.csv, which
// has the columns applies_to,field,value. `applies_to` is sweeps/NAME or scenarios/NAME. `field` is one of:
//     repetitions   number of seeds of each combination
//     axis NAME     the values of the sweep axis NAME that remain, separated by ';'
//     PATH          path of a scenario field, such as duration, to which `value` is assigned (as with --set)
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenario/sweep_file/sweep_settings.h"

namespace stopline {

class Reductions {
public:
    struct Row {
        std::string applies_to;
        std::string field;
        std::string value;
    };

    Reductions() = default;  // no reduction
    // Throws InputError if the file cannot be read or a row is invalid.
    static Reductions load(const std::filesystem::path& file);

    const std::vector<Row>& rows() const { return rows_; }
    // Returns one warning for each column of the file that still has its name of the previous release.
    const std::vector<std::string>& warnings() const { return warnings_; }

    // Returns the scenario fields that the reductions change, each as "PATH=VALUE", for load_scenario().
    std::vector<std::string> settings(const std::string& applies_to) const;
    // Returns the reduced number of seeds, or std::nullopt if the number is not reduced.
    std::optional<int> repetitions(const std::string& applies_to) const;
    // Reduces axes and repetitions of a sweep. Throws InputError for an axis or a value that the sweep does not have.
    void apply(SweepSettings& sweep) const;

private:
    std::vector<Row> rows_;
    std::vector<std::string> warnings_;
};

}  // namespace stopline

// Measurements of an experiment as named numbers, stored in one CSV file for each experiment. Only the same program
// with the same scenario reuses them.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "scenario/scenario.h"

namespace stopline {

class Measurements {
public:
    void set(const std::string& name, double value) { values_[name] = value; }
    // Returns nothing if the value was not measured, and NaN if it was measured without a result.
    std::optional<double> find(const std::string& name) const;
    const std::map<std::string, double>& values() const { return values_; }

private:
    std::map<std::string, double> values_;
};

// Returns all that results depend on: scenario hash, version, and a hash of the running program's bytes. Returns
// nothing if the program file cannot be read; stored measurements are then not reused.
std::optional<std::string> results_key(const Scenario& scenario);

// Returns nothing if the file is missing, damaged, or was stored with another key.
std::optional<Measurements> load_measurements(const std::filesystem::path& file, const std::string& key);
void store_measurements(const std::filesystem::path& file, const std::string& key, const Measurements& measurements);

}  // namespace stopline

// Measurements of an experiment as named numbers, stored in one CSV file for each experiment. A later run reuses the
// file only if program and scenario are the same and the checksum in the file fits.
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
    // Returns std::nullopt if no value has this name. NaN means that the experiment ran, but gave no number.
    std::optional<double> find(const std::string& name) const;
    const std::map<std::string, double>& values() const { return values_; }

private:
    std::map<std::string, double> values_;
};

// Returns a text that identifies scenario and program: the scenario hash, the version, and a hash of the program file.
// Returns std::nullopt if the program file cannot be read. In this case, do not reuse stored measurements.
std::optional<std::string> results_key(const Scenario& scenario);

// Loads stored measurements. Returns std::nullopt if the file is missing or damaged, or was stored with a key other
// than `key`.
std::optional<Measurements> load_measurements(const std::filesystem::path& file, const std::string& key);
void store_measurements(const std::filesystem::path& file, const std::string& key, const Measurements& measurements);

}  // namespace stopline

// What an experiment has measured, as a flat list of named numbers, and its store: a CSV file a experiment that is used again
// only by the same program with the same scenario.
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
    // Nothing where it was not measured; NaN where it was, and there was nothing to find.
    std::optional<double> find(const std::string& name) const;
    const std::map<std::string, double>& values() const { return values_; }

private:
    std::map<std::string, double> values_;
};

// Scenario hash, version, and a hash over the bytes of the running program: what results depend on. Nothing where the program
// cannot be read; then nothing is reused.
std::optional<std::string> results_key(const Scenario& scenario);

// Nothing where the file is missing, damaged, or was written under another key.
std::optional<Measurements> load_measurements(const std::filesystem::path& file, const std::string& key);
void store_measurements(const std::filesystem::path& file, const std::string& key, const Measurements& measurements);

}  // namespace stopline

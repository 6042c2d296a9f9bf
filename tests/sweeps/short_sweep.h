// A sweep whose runs take a few milliseconds: two green times, two vehicle types, three populations, two seeds.
#pragma once

#include <string>
#include <vector>

#include "scenario/scenario_text.h"
#include "scenario/sweep_file/load_sweep.h"
#include "sweeps/sweep.h"

namespace stopline {

constexpr const char* kShortSweepScenario = R"(
duration: 100 s
network: {approach: {length: 200 m, exit_length: 800 m}}
signal: {first_green: 50 s, green: 20 s}
demand: {vehicles: 8}
populations:
- CDG
- {name: MIX, pattern: random, components: [{policy: CDG, share: 50 %}, {policy: CTG-Ref, share: 50 %}]}
- CTG-Ref
measure: {green: [5 s, 10 s]}
)";

constexpr const char* kShortSweep = R"(
scenario: short.yaml
axes:
- {name: green, path: signal.green, values: [15 s, 20 s]}
- {name: vehicle, path: vehicle, values: [petrol_eu4_72kw, electric_100kw]}
repetitions: 2
)";

// Writes the scenario and the sweep file into a temporary folder and loads the sweep from there.
class ShortSweep {
public:
    explicit ShortSweep(const std::string& text = kShortSweep) {
        folder.write("short.yaml", kShortSweepScenario);
        file = folder.write("sweep.yaml", text);
    }
    Sweep load(const std::vector<std::string>& overrides = {}, int threads = 1) const {
        SweepOptions options;
        options.overrides = overrides;
        options.threads = threads;
        return Sweep(load_sweep(file), options);
    }
    // Returns the error message of loading the sweep; empty: no error.
    std::string error(const std::vector<std::string>& overrides = {}) const {
        return input_error_of([&] { static_cast<void>(load(overrides)); });
    }

    TemporaryFolder folder;
    std::filesystem::path file;
};

}  // namespace stopline

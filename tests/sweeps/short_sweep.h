// A sweep of runs that take a few milliseconds: two green times, two vehicles, three populations, two seeds.
#pragma once

#include <string>
#include <vector>

#include "sweeps/sweep.h"
#include "scenario/sweep_file/load_sweep.h"
#include "scenario/scenario_text.h"

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

// The two files in a folder of their own, and the sweep loaded from there.
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
    std::string error(const std::vector<std::string>& overrides = {}) const {
        return input_error_of([&] { static_cast<void>(load(overrides)); });
    }

    TemporaryFolder folder;
    std::filesystem::path file;
};

}  // namespace stopline

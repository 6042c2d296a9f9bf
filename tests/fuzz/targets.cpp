#include "fuzz/targets.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

#include "fuzz/mutators.h"

namespace stopline::fuzz {

namespace {

constexpr std::array kTargets{
    Target{"quantities", run_quantities},
    Target{"formulas", run_formulas},
    Target{"overrides", run_overrides, mutate_overrides},
    Target{"scenario", run_scenario, mutate_yaml},
    Target{"streets", run_streets, mutate_yaml},
    Target{"sweep", run_sweep, mutate_yaml},
    Target{"sumo_net", run_sumo_net, mutate_xml},
    Target{"sumo_additional", run_sumo_additional, mutate_xml},
    Target{"sumo_routes", run_sumo_routes, mutate_xml},
    Target{"recording", run_recording, mutate_recording},
};

}  // namespace

std::span<const Target> targets() { return kTargets; }

std::filesystem::path seeds_folder() { return STOPLINE_FUZZ_SEEDS; }

const Target& target(std::string_view name) {
    const auto* const found =
        std::find_if(kTargets.begin(), kTargets.end(), [&](const Target& one) { return one.name == name; });
    if (found != kTargets.end()) return *found;
    static_cast<void>(std::fprintf(stderr, "there is no fuzz target '%s'\n", std::string(name).c_str()));
    std::abort();
}

}  // namespace stopline::fuzz

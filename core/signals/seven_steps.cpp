// The signal programmes of streets, in the seven steps of Table 3 of the paper.
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/input_error.h"
#include "signals/programme.h"

namespace stopline {

namespace {

constexpr std::size_t kSteps = 7;
using Lights = std::array<Light, kSteps>;

// Makes the programme of one signal group. Steps of zero length are omitted, and consecutive steps with the same light
// are merged.
GroupProgramme programme_of(const std::array<std::int64_t, kSteps>& ticks, const Lights& lights, std::int64_t offset) {
    std::vector<Stage> stages;
    std::int64_t cycle = 0;
    for (std::size_t k = 0; k < kSteps; ++k) {
        cycle += ticks[k];
        if (ticks[k] == 0) continue;
        if (!stages.empty() && stages.back().light == lights[k]) {
            stages.back().ticks += ticks[k];
        } else {
            stages.push_back({ticks[k], lights[k]});
        }
    }
    if (cycle <= 0) throw InputError("signal programme: the seven steps must sum to more than 0 s");
    // If the first and the last stage have the same light, the first stage is merged into the last stage. The programme
    // then begins with the second stage.
    if (stages.size() > 1 && stages.front().light == stages.back().light) {
        offset += stages.front().ticks;
        stages.back().ticks += stages.front().ticks;
        stages.erase(stages.begin());
    }
    return {std::move(stages), offset % cycle - cycle, true};
}

}  // namespace

std::array<GroupProgramme, 3> make_seven_steps(const SevenSteps& steps, double offset_s, double step_s) {
    std::array<std::int64_t, kSteps> ticks{};
    for (std::size_t k = 0; k < kSteps; ++k) ticks[k] = to_ticks(steps.steps_s()[k], step_s);
    const std::int64_t offset = to_ticks(offset_s, step_s);
    using enum Light;
    return {programme_of(ticks, {green, yellow, red, red, red, red, red}, offset),
            programme_of(ticks, {green, yellow, red, green, red, red, red}, offset),
            programme_of(ticks, {red, red, red, red, green, yellow, red}, offset)};
}

std::vector<GroupProgramme> make_street_signals(const StreetSettings& streets, double step_s) {
    std::vector<GroupProgramme> programmes;
    for (const StreetIntersection& node : streets.intersections) {
        for (GroupProgramme& programme : make_seven_steps(node.programme, node.offset_s, step_s)) {
            programmes.push_back(std::move(programme));
        }
    }
    return programmes;
}

}  // namespace stopline

#include "signals/programme.h"

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/input_error.h"

namespace stopline {

std::int64_t to_ticks(double seconds, double step_s) { return std::llround(seconds / step_s); }

GroupProgramme::GroupProgramme(std::vector<Stage> stages, std::int64_t offset_ticks, bool repeats)
    : stages_(std::move(stages)), offset_(offset_ticks), repeats_(repeats) {
    for (const Stage& stage : stages_) {
        if (stage.ticks <= 0) throw InputError("signal programme: every stage must last at least one time step");
        cycle_ += stage.ticks;
    }
    if (stages_.empty()) throw InputError("signal programme: at least one stage is needed");
}

GroupProgramme::GroupProgramme(Timeline<Light> lights, std::int64_t cycle_ticks)
    : offset_(lights.first_tick()), cycle_(cycle_ticks), repeats_(true), timeline_(std::move(lights)) {}

GroupProgramme::StageStart GroupProgramme::stage_at(std::int64_t tick) const {
    std::int64_t start = offset_ + (tick - offset_) / cycle_ * cycle_;
    std::size_t stage = 0;
    while (tick >= start + stages_[stage].ticks) start += stages_[stage++].ticks;
    return {stage, start};
}

Light GroupProgramme::light(std::int64_t tick) const {
    if (!timeline_.empty()) return timeline_.at(tick);
    if (tick < offset_) return Light::red;
    if (!repeats_ && tick >= offset_ + cycle_) return Light::red;
    return stages_[stage_at(tick).stage].light;
}

std::int64_t GroupProgramme::light_start_tick(std::int64_t tick) const {
    if (!timeline_.empty()) return timeline_.start_tick(tick);
    if (tick < offset_) return 0;
    if (!repeats_ && tick >= offset_ + cycle_) return offset_ + cycle_;
    return stage_at(tick).tick;
}

std::int64_t GroupProgramme::next_change_tick(std::int64_t tick) const {
    if (!timeline_.empty()) return timeline_.next_change_tick(tick);
    if (tick < offset_) return offset_;
    if (!repeats_ && tick >= offset_ + cycle_) return std::numeric_limits<std::int64_t>::max();
    const StageStart start = stage_at(tick);
    return start.tick + stages_[start.stage].ticks;
}

std::int64_t GroupProgramme::last_green_start_tick(std::int64_t tick) const {
    while (tick >= 0 && light(tick) != Light::green) tick = light_start_tick(tick) - 1;
    return tick < 0 ? kNoGreen : light_start_tick(tick);
}

GroupProgramme make_single_light(const SignalSettings& s, double step_s) {
    const bool repeats = s.cycle_s > 0.0;
    const double red_s = repeats ? s.cycle_s - s.green_s - s.yellow_s : s.all_red_s;
    if (red_s < 0.0 || (repeats && red_s < s.all_red_s)) {
        throw InputError(
            fmt::format("signal: the cycle of {} s is shorter than green {} s, yellow {} s and all red {} s", s.cycle_s,
                        s.green_s, s.yellow_s, s.all_red_s));
    }
    std::vector<Stage> stages{{to_ticks(s.green_s, step_s), Light::green}};
    if (s.yellow_s > 0.0) stages.push_back({to_ticks(s.yellow_s, step_s), Light::yellow});
    if (red_s > 0.0) stages.push_back({to_ticks(red_s, step_s), Light::red});
    return {std::move(stages), to_ticks(s.first_green_s, step_s), repeats};
}

std::vector<GroupProgramme> make_stage_programmes(const SignalSettings& settings, int groups, double step_s) {
    double cycle_s = 0.0;
    for (int group = 0; group < groups; ++group) cycle_s += settings.stage_s(group);
    std::vector<GroupProgramme> programmes;
    double begin_s = settings.first_green_s;
    for (int group = 0; group < groups; ++group) {
        SignalSettings group_settings = settings;
        group_settings.first_green_s = begin_s;
        group_settings.green_s = settings.group_green_s(group);
        group_settings.cycle_s = cycle_s;
        begin_s += settings.stage_s(group);
        programmes.push_back(make_single_light(group_settings, step_s));
    }
    return programmes;
}

}  // namespace stopline

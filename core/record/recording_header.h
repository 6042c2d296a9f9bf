// The head of a recording as JSON: where the run comes from, units, and all that is needed to draw it.
//
//     program, version, command, scenario, title, scenario_hash, seed, population, fidelity
//     step_s, frame_s, first_frame_s, position_unit_m, speed_unit_mps, advance_q12 (see expected_advance)
//     policies: [name], causes: [name], signal_groups: number, lane_width_m
//     lanes: [{name, length_m, limit_mps, next: [lane], shape: [x, y, ...], shape_start_m, shape_scale if not 1,
//              stop_line_m where it has one, signal_group where that has a light, turn and origin inside an intersection}]
//     entries: [lane]
// Lanes, groups, policies and causes are numbered as they are listed, from 0. For shape_start_m and shape_scale see network/lane_graph.h.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "record/frame_clock.h"
#include "sim/model.h"

namespace stopline {

// What the model does not know of itself.
struct RunOrigin {
    std::string command;
    std::string scenario;
    std::string title;
    std::string scenario_hash;
    std::uint64_t seed = 1;
    std::string population;
    double lane_width_m = 3.5;
};

// Frames and their units.
struct FrameGrid {
    std::int64_t first_tick = 0;
    std::int64_t every_ticks = 1;
    double step_s = 0.1;
    double position_unit_m = 0.01;
    std::uint32_t advance_q12 = 0;

    double time_s(std::int64_t frame) const { return static_cast<double>(first_tick + frame * every_ticks) * step_s; }
};

// Positions take the finest unit with which the longest lane fits into 16 bits.
FrameGrid make_frame_grid(const Model& model, const FrameClock& clock);

std::string recording_header(const Model& model, const RunOrigin& origin, const FrameGrid& grid);

// What a reader of the frames needs of it. Throws InputError where something is missing or cannot be used.
struct RecordedRun {
    struct RecordedLane {
        std::string name;
        double length_m = 0.0;
        int signal_group = -1;
        double stop_line_m = 0.0;
    };
    RunOrigin origin;
    std::string version;
    FrameGrid grid;
    std::vector<RecordedLane> lanes;
    std::vector<std::string> policies;
    std::vector<std::string> causes;
    int signal_groups = 0;
};
RecordedRun parse_recording_header(std::string_view json);

}  // namespace stopline

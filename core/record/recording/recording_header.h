// The header of a recording as JSON: the origin of the run, the units, and all data for drawing the network.
//
//     program, version, command, scenario, title, scenario_hash, seed, population, fidelity
//     step_s, frame_s, first_frame_s, position_unit_m, speed_unit_mps, advance_q12 (see expected_advance)
//     policies: [name], causes: [name], signal_groups: number, lane_width_m
//     links: [name of a kind of links between vehicles], only if links can occur (vehicle_links.h)
//     lanes: [{name, length_m, limit_mps, next: [lane], shape: [x, y, ...], shape_start_m, shape_scale unless it is 1,
//              stop_line_m and signal_group if the lane has them, turn and origin if the lane is a connection}]
//     entries: [lane where vehicles enter the network]
// Lanes, policies and delay causes are numbered from 0 in the order of these lists, and signal groups from 0, too.
// network/lane_graph.h explains shape_start_m and shape_scale.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "record/recording/frame_clock.h"
#include "sim/state/model.h"

namespace stopline {

// Facts about the origin of a run, which the model does not contain.
struct RunOrigin {
    std::string command;  // command line that makes the same recording again
    std::string scenario;
    std::string title;
    std::string scenario_hash;
    std::uint64_t seed = 1;
    std::string population;
    double lane_width_m = 3.5;
};

// The times of the frames, and the units of the positions in them.
struct FrameGrid {
    std::int64_t first_tick = 0;
    std::int64_t frame_ticks = 1;  // ticks from one frame to the next
    double step_s = 0.1;
    double position_unit_m = 0.01;
    std::uint32_t advance_q12 = 0;  // see expected_advance()

    // Returns the time of a frame, s. Frames are counted from 0.
    double time_s(std::int64_t frame) const { return static_cast<double>(first_tick + frame * frame_ticks) * step_s; }
};

// Returns the grid for a model. The position unit is the smallest multiple of kFinestPosition_m with which every
// position on the longest lane fits into 16 bits.
FrameGrid make_frame_grid(const Model& model, const FrameClock& clock);

// Returns the header as JSON text.
std::string recording_header(const Model& model, const RunOrigin& origin, const FrameGrid& grid);

// The part of the header that a program needs to read the frames.
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
    std::vector<std::string> links;  // kinds of links between vehicles
    int signal_groups = 0;
};
// Parses the header. Throws InputError if a value is missing or out of range.
RecordedRun parse_recording_header(std::string_view json);

}  // namespace stopline

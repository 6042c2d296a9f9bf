// The user's settings of a signal: its controller, and the times of an initial red and of cycles of green, yellow and
// red. SI units.
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace stopline {

inline constexpr std::size_t kMaxSignalParameters = 32;

struct SignalSettings {
    std::string controller = "fixed_time";  // name of a SignalController
    double first_green_s = 120.0;           // start of the first green; until then the signal is red and a queue forms
    double green_s = 60.0;
    double yellow_s = 3.0;
    double all_red_s = 5.0;
    double cross_green_s = 0.0;  // green of the streets from south to north; 0: the same as green_s
    double offset_s = 0.0;       // grid: delay of the green, per column to the east and per row to the north
    double cycle_s = 0.0;        // only for the network kind `approach`; 0: one green, then red until the end

    // Parameters of controllers in SI units, in the order of signal_parameters() (signals/signal_controller.h).
    std::array<double, kMaxSignalParameters> parameters{};

    // The functions below are for intersections and grids. Even signal groups serve the streets from west to east, and
    // odd signal groups serve the streets from south to north.
    double group_green_s(int group) const { return group % 2 == 1 && cross_green_s > 0.0 ? cross_green_s : green_s; }
    double stage_s(int group) const { return group_green_s(group) + yellow_s + all_red_s; }
    double intersection_cycle_s() const { return stage_s(0) + stage_s(1); }
};

}  // namespace stopline

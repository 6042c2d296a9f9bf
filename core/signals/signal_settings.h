// What a user says of a fixed-time signal: red first (lead-in), then cycles of green, yellow and red. SI units.
#pragma once

namespace stopline {

struct SignalSettings {
    double first_green_s = 120.0;  // red until then (the queue forms); later cycles repeat from here
    double green_s = 60.0;
    double yellow_s = 3.0;
    double all_red_s = 5.0;
    double offset_s = 0.0;  // of a grid: greens start later by this from one intersection to the next
    double cycle_s = 0.0;   // 0: a single green, red for the rest of the run
};

}  // namespace stopline

// What a user says of a fixed-time signal: red first (lead-in), then cycles of green, yellow and red. SI units.
#pragma once

namespace stopline {

struct SignalSettings {
    double first_green_s = 120.0;  // red until then (the queue forms); later cycles repeat from here
    double green_s = 60.0;
    double yellow_s = 3.0;
    double all_red_s = 5.0;
    double cross_green_s = 0.0;  // of the streets from south to north; 0: as the others
    double offset_s = 0.0;       // of a grid: greens start later by this from one intersection to the next
    double cycle_s = 0.0;        // 0: a single green, red for the rest of the run

    // Intersections: streets from west to east are group 0, those from south to north group 1.
    double green_of_s(int group) const { return group % 2 == 1 && cross_green_s > 0.0 ? cross_green_s : green_s; }
    double stage_s(int group) const { return green_of_s(group) + yellow_s + all_red_s; }
    double both_stages_s() const { return stage_s(0) + stage_s(1); }  // the cycle of an intersection
};

}  // namespace stopline

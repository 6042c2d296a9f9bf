// Cost of the mesoscale mode on grids of intersections, with all that a run of Section VI does: signals, giving way, hindrance, vehicles
// that are moved on, detectors.
#pragma once

#include <array>
#include <string>

namespace stopline {

inline constexpr const char* kGrid = "meso_grid_25_intersections";  // of Section VI.C, 15 s green, 5 % / 10 % turns
inline constexpr std::array<const char*, 3> kGridPopulations{"CTG-Ref", "MIX", "CDG"};
inline constexpr const char* kLargeGrid = "meso_grid_with_queues";  // with a queue on every road
inline constexpr std::array<int, 5> kGridSides{3, 6, 11, 33,
                                               102};  // streets each way: about 1,000 to 1,000,000 vehicles
inline constexpr int kSharedSide = 33;                // of the run that threads share
inline constexpr const char* kVehiclesCounter = "vehicles";
inline constexpr const char* kBytesCounter = "bytes_per_vehicle";  // resident memory that the run adds to the network's

std::string grid_name(const char* population);
std::string large_grid_name(int side, int threads);

void add_network_benchmarks();

}  // namespace stopline

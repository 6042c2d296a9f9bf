// Benchmarks of the mesoscale mode on grids of intersections, with all parts of a run of Section VI: signals, right of
// way, delay causes, teleporting and detectors.
#pragma once

#include <array>
#include <string>

namespace stopline {

inline constexpr const char* kGrid = "meso_grid_25_intersections";  // of Section VI.C, 15 s green, 5 % / 10 % turns
inline constexpr std::array<const char*, 3> kGridPopulations{"CTG-Ref", "MIX", "CDG"};
inline constexpr const char* kLargeGrid = "meso_grid_with_queues";  // a queue on every road
// Streets in each direction. The grids have about 1,000 to 1,000,000 vehicles.
inline constexpr std::array<int, 5> kGridSides{3, 6, 11, 33, 102};
inline constexpr int kTwoThreadSide = 33;  // streets in each direction of the grid that also runs with two threads
inline constexpr const char* kVehiclesCounter = "vehicles";
inline constexpr const char* kBytesCounter = "bytes_per_vehicle";  // resident memory of the run without its model

std::string grid_name(const char* population);
std::string large_grid_name(int side, int threads);

void add_network_benchmarks();

}  // namespace stopline

// Benchmarks of the mesoscale mode on grids of intersections, with all parts of the runs of Section VI of the paper:
// signals, right of way, delay causes, teleporting and detectors.
#pragma once

#include <array>
#include <string>

namespace stopline {

// Name of the benchmarks on the grid of Section VI.C: 15 s green, 5 % left and 10 % right turns.
inline constexpr const char* kGrid = "meso_grid_25_intersections";
inline constexpr std::array<const char*, 3> kGridPopulations{"CTG-Ref", "MIX", "CDG"};
// Name of the benchmarks on grids of several sizes, with a queue on every road.
inline constexpr const char* kLargeGrid = "meso_grid_with_queues";
// Numbers of streets in each direction of the large grids, which have about 1,000 to 1,000,000 vehicles.
inline constexpr std::array<int, 5> kGridSides{3, 6, 11, 33, 102};
inline constexpr int kTwoThreadSide = 33;  // streets in each direction of the grid that also runs with two threads
inline constexpr const char* kVehiclesCounter = "vehicles";
// Name of the counter of resident memory per vehicle. The memory of the Model is not counted.
inline constexpr const char* kBytesCounter = "bytes_per_vehicle";

std::string grid_name(const char* population);
std::string large_grid_name(int side, int threads);

void add_network_benchmarks();

}  // namespace stopline

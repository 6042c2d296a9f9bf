// Vehicles by interval, origin and destination or turn: the content of a file with detector counts or with an
// origin-destination matrix.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace stopline {

struct TrafficRow {
    double from_s = 0.0;
    double to_s = 0.0;
    std::string origin;       // name of an approach where vehicles enter the network
    std::string destination;  // name of a leg where vehicles leave the network; "": the turns or shares apply
    std::int64_t vehicles = 0;
    // Number of these vehicles that turn left, go straight on and turn right. They sum to `vehicles`.
    std::optional<std::array<std::int64_t, 3>> turns;
};

struct TrafficTable {
    std::vector<TrafficRow> rows;  // sorted by from_s
    std::uint64_t hash = 0;        // of the text of the file
};

}  // namespace stopline

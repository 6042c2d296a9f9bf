#include "scenario/approach_names.h"

#include <algorithm>
#include <cstddef>

#include "network/lane_graph.h"
#include "scenario/make_network.h"

namespace stopline {

std::vector<std::string> approach_names(const NetworkSettings& network) {
    const LaneGraph graph = make_network(network);
    std::vector<std::string> names;
    for (const std::vector<int>& lanes : {graph.entries, graph.links}) {
        for (const int lane : lanes) {
            const std::string& name = graph.lanes[static_cast<std::size_t>(lane)].name;
            names.push_back(name.substr(0, name.rfind("_in_")));
        }
    }
    std::vector<std::string> unique;
    for (const std::string& name : names) {
        if (std::find(unique.begin(), unique.end(), name) == unique.end()) unique.push_back(name);
    }
    return unique;
}

}  // namespace stopline

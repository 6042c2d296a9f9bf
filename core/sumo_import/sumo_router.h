// Fastest routes through an imported network.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "base/containers/packed_lists.h"
#include "sumo_import/sumo_graph.h"

namespace stopline {

class SumoRouter {
public:
    explicit SumoRouter(const SumoNetwork& network);

    // Returns the turn from one edge to another, or Turn::none if no connection joins the edges.
    Turn turn(int from, int to) const;
    // Returns the edges of the route with the least free-flow travel time, including `from` and `to`. Returns nothing
    // if there is no route. If several routes are equally fast, earlier calls do not influence which one is returned.
    //
    // The search is A* backwards from `to`, with lower bounds from landmarks (Goldberg, Harrelson 2005: "Computing the
    // shortest path: A* search meets graph theory"). This search looks at little more than the edges on fastest routes.
    // Many successive calls with the same `to` share one shortest-path tree instead (Dijkstra 1959).
    std::optional<std::vector<int>> fastest_route(int from, int to);
    // Returns true if the edge is open to passenger cars.
    bool allows_cars(int edge) const { return network_.approach_of[static_cast<std::size_t>(edge)] >= 0; }

private:
    struct Link {
        int edge;
        Turn turn;
        double time_s;  // free-flow travel time in the junction
    };
    // A candidate of a search: the key by which candidates are sorted (a travel time, or a lower bound of it), and an
    // edge.
    using Candidate = std::pair<double, int>;
    static constexpr std::size_t kLandmarks = 16;
    // Travel times between one edge and the landmarks. Single precision halves the memory.
    struct LandmarkTimes {
        std::array<float, kLandmarks> from_s{};  // from each landmark to the edge
        std::array<float, kLandmarks> to_s{};    // from the edge to each landmark
    };

    void start(int to);
    void settle(int target);
    void search(int from);
    std::vector<int> route(int from) const;
    int next_edge(int edge) const;
    static double difference_s(float longer_s, float shorter_s);
    void choose_active(int from);
    double lower_bound_s(int from, int edge) const;
    void choose_landmarks();
    std::vector<float> travel_times_s(int edge, bool backwards);

    const SumoNetwork& network_;
    PackedLists<Link> successors_;          // [edge]
    PackedLists<Link> predecessors_;        // [edge]
    std::vector<double> time_s_;            // [edge] free-flow travel time
    std::vector<LandmarkTimes> landmarks_;  // [edge]; empty until there have been some searches
    static constexpr std::size_t kActive = 4;
    // Landmarks that the present search uses. The number k stands for travel times from landmark k, and the number k +
    // kLandmarks for travel times to landmark k.
    std::array<std::size_t, kActive> active_{};
    std::size_t active_count_ = 0;
    int searches_ = 0;  // searches without landmarks so far
    // The next members are the state of the present search, which looks for routes to the edge to_.
    int to_ = -1;
    int requests_ = 0;                 // successive calls with this to_
    bool is_tree_ = false;             // the search builds the shortest-path tree of to_
    std::vector<double> remaining_s_;  // [edge] travel time from the end of the edge to the end of to_
    std::vector<char> settled_;        // [edge] 1: the edge has been visited; in a tree its remaining_s_ is then final
    std::vector<int> changed_;         // edges whose remaining_s_ has been set
    std::vector<Candidate> open_;      // min-heap
};

}  // namespace stopline

#include "sumo_import/sumo_right_of_way.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <unordered_map>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "network/conflicts.h"

namespace stopline {

namespace {

// Returns a bit of a right-of-way matrix, or false if row or column is outside the matrix.
bool bit(const std::vector<std::vector<bool>>& matrix, int row, int column) {
    return row >= 0 && column >= 0 && at(row) < matrix.size() && at(column) < matrix.size() &&
           matrix[at(row)][at(column)];
}

bool is_major(char letter) { return letter == 'G' || letter == 'O'; }

class ConflictFinder {
public:
    ConflictFinder(SumoNetwork& network, std::vector<BuiltConnection>& connections, double clearance_m)
        : network_(network), connections_(connections), clearance_m_(clearance_m) {}

    void find_all() {
        network_.graph.conflicts.assign(network_.graph.lanes.size(), {});
        number_links_without_via();
        std::vector<std::vector<int>> connections_of(network_.net.junctions.size());
        for (std::size_t k = 0; k < connections_.size(); ++k) {
            if (connections_[k].junction >= 0)
                connections_of[at(connections_[k].junction)].push_back(static_cast<int>(k));
        }
        for (std::size_t k = 0; k < connections_of.size(); ++k) {
            const SumoJunction& junction = network_.net.junctions[k];
            const std::vector<int>& connections = connections_of[k];
            if (junction.response.empty()) warn_of_missing_requests(junction, connections);
            for (std::size_t first = 0; first < connections.size(); ++first) {
                for (std::size_t second = first + 1; second < connections.size(); ++second) {
                    add(junction, connections_[at(connections[first])], connections_[at(connections[second])]);
                }
            }
        }
        for (BuiltConnection& connection : connections_) {
            const bool has_link = connection.junction >= 0 && connection.link >= 0;
            const std::vector<bool> no_bits;
            const std::vector<bool>& cont = has_link ? network_.net.junctions[at(connection.junction)].cont : no_bits;
            lane(connection).waits_inside = has_link && at(connection.link) < cont.size() && cont[at(connection.link)];
            std::vector<Conflict>& conflicts = network_.graph.conflicts[at(connection.lane)];
            std::stable_sort(conflicts.begin(), conflicts.end(),
                             [](const Conflict& a, const Conflict& b) { return a.from_m < b.from_m; });
            if (conflicts.empty()) lane(connection).keep_clear = false;
        }
    }

private:
    Lane& lane(const BuiltConnection& connection) { return network_.graph.lanes[at(connection.lane)]; }

    // Sets junction and link number of connections without internal lanes. SUMO numbers the links of a junction in the
    // order of its incoming lanes. Links from the same lane are numbered in the order of the file.
    void number_links_without_via() {
        std::unordered_map<std::string, std::vector<BuiltConnection*>> from;
        for (BuiltConnection& connection : connections_) {
            if (connection.source->via >= 0) continue;
            from[network_.graph.lanes[at(lane(connection).origin)].name].push_back(&connection);
        }
        for (std::size_t junction = 0; junction < network_.net.junctions.size() && !from.empty(); ++junction) {
            int link = 0;
            for (const std::string& incoming : network_.net.junctions[junction].incoming) {
                const auto found = from.find(incoming);
                if (found == from.end()) continue;
                for (BuiltConnection* connection : found->second) {
                    connection->junction = static_cast<int>(junction);
                    connection->link = link++;
                }
            }
        }
    }

    void add(const SumoJunction& junction, const BuiltConnection& first, const BuiltConnection& second) {
        const Lane& a = lane(first);
        const Lane& b = lane(second);
        const bool foes = bit(junction.foes, first.link, second.link) || bit(junction.foes, second.link, first.link);
        const bool has_u_turn = is_u_turn(first) || is_u_turn(second);
        if (a.origin == b.origin || (!foes && a.next != b.next && !has_u_turn)) return;
        const std::optional<Conflict> c = conflict_of(a, b, clearance_m_);
        if (!c) return;
        const bool matrix_decides = foes || a.next == b.next;
        const bool first_yields = matrix_decides ? yields(junction, first, second) : yields_at_u_turn(first, second);
        const bool second_yields = matrix_decides ? yields(junction, second, first) : yields_at_u_turn(second, first);
        network_.graph.conflicts[at(first.lane)].push_back(
            {second.lane, c->from_m, c->to_m, c->other_from_m, c->other_to_m, first_yields, second_yields});
        network_.graph.conflicts[at(second.lane)].push_back(
            {first.lane, c->other_from_m, c->other_to_m, c->from_m, c->to_m, second_yields, first_yields});
    }

    // Warns if a junction without `request` elements has connections that cross. At such a junction, vehicles obey only
    // signals.
    void warn_of_missing_requests(const SumoJunction& junction, const std::vector<int>& connections) {
        for (const int first : connections) {
            for (const int second : connections) {
                const Lane& a = lane(connections_[at(first)]);
                const Lane& b = lane(connections_[at(second)]);
                if (first >= second || a.origin == b.origin || a.next == b.next || !conflict_of(a, b, clearance_m_))
                    continue;
                network_.net.warnings.note(
                    junction.where,
                    fmt::format(
                        "junction '{}' of type '{}' has no requests: vehicles do not yield there, and drive through "
                        "each other where their paths cross",
                        junction.id, junction.type));
                return;
            }
        }
    }

    static bool is_u_turn(const BuiltConnection& connection) { return connection.source->dir == 't'; }

    // Returns true if `connection` yields to `to`. Call this function only for two connections that have different exit
    // lanes and are no foes in the matrix. They conflict only because the import extends U-turns (sumo_graph.cpp). A
    // U-turn yields to every other movement. Of two U-turns, the one with the higher link number yields.
    static bool yields_at_u_turn(const BuiltConnection& connection, const BuiltConnection& to) {
        return is_u_turn(connection) && (!is_u_turn(to) || connection.link > to.link);
    }

    // Returns true if `connection` yields to `to`. Links of the same signal yield to each other only if they are green
    // together in some phase.
    bool yields(const SumoJunction& junction, const BuiltConnection& connection, const BuiltConnection& to) const {
        if (connection.source->pass) return false;
        const bool must_yield = bit(junction.response, connection.link, to.link);
        const int tl = connection.source->tl;
        if (tl < 0 || tl != to.source->tl) {
            // If the matrix makes neither link yield, the link with the higher number yields, and every link yields to
            // a link with the attribute `pass`. If both links have the same number, is_left_of() decides.
            const bool undecided = !must_yield && !bit(junction.response, to.link, connection.link);
            return must_yield ||
                   (undecided && (to.source->pass || connection.link > to.link || is_left_of(connection, to)));
        }
        bool together = false;
        bool minor = false;
        bool major = false;
        for (const SumoPhase& phase : network_.net.signals[at(tl)].phases) {
            const char own = phase.state[at(connection.source->tl_link)];
            const char other = phase.state[at(to.source->tl_link)];
            if (phase.duration_s <= 0.0 || !sumo_is_green(own) || !sumo_is_green(other)) continue;
            together = true;
            minor = minor || (!is_major(own) && is_major(other));
            major = major || (is_major(own) && !is_major(other));
        }
        const bool later = junction.response.empty() && !major && connection.link > to.link;
        return together && (minor || must_yield || later || is_left_of(connection, to));
    }

    // When a short edge is merged (sumo_short_edges.h), its connection can be copied to several lanes. Returns true if
    // `connection` and `other` are such copies of one connection, and `connection` begins on a lane further left. Of
    // two copies, the left copy yields.
    static bool is_left_of(const BuiltConnection& connection, const BuiltConnection& other) {
        const SumoConnection& own = *connection.source;
        const SumoConnection& others = *other.source;
        return own.via >= 0 && own.via == others.via && own.via_lane == others.via_lane &&
               own.from_lane > others.from_lane;
    }

    SumoNetwork& network_;
    std::vector<BuiltConnection>& connections_;
    double clearance_m_;
};

}  // namespace

void find_sumo_conflicts(SumoNetwork& network, std::vector<BuiltConnection>& connections, double clearance_m) {
    ConflictFinder(network, connections, clearance_m).find_all();
}

}  // namespace stopline

#include "sumo_import/sumo_right_of_way.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <unordered_map>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/input_error.h"
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
            if (connections.size() > kSumoLinksMax) {
                throw InputError(fmt::format("{}: junction '{}' has {} connections; at most {} are allowed",
                                             junction.where, junction.id, connections.size(), kSumoLinksMax));
            }
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
            if (!has_signal(connection)) lane(connection).stop_rule = stop_rule_of(connection.source->state);
            std::vector<Conflict>& conflicts = network_.graph.conflicts[at(connection.lane)];
            std::stable_sort(conflicts.begin(), conflicts.end(),
                             [](const Conflict& a, const Conflict& b) { return a.from_m < b.from_m; });
            if (conflicts.empty()) lane(connection).keep_clear = false;
        }
    }

private:
    Lane& lane(const BuiltConnection& connection) { return network_.graph.lanes[at(connection.lane)]; }

    // Sets junction and link number of connections without internal lanes. A junction of SUMO numbers its links in the
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
        const bool zipper = a.next == b.next && is_without_signal(first, 'Z') && is_without_signal(second, 'Z');
        Priority priority;
        if (!matrix_decides) {
            priority = {yields_at_u_turn(first, second), yields_at_u_turn(second, first)};
        } else if (!zipper && !(is_without_signal(first, 'w') && is_without_signal(second, 'w'))) {
            priority = priority_of(junction, first, second);
        }
        network_.graph.conflicts[at(first.lane)].push_back({second.lane, c->from_m, c->to_m, c->other_from_m,
                                                            c->other_to_m, priority.first_yields,
                                                            priority.second_yields, zipper});
        network_.graph.conflicts[at(second.lane)].push_back({first.lane, c->other_from_m, c->other_to_m, c->from_m,
                                                             c->to_m, priority.second_yields, priority.first_yields,
                                                             zipper});
    }

    // Warns if connections from different lanes to different lanes cross in the junction. Call this function for a
    // junction without right-of-way matrices (`request` elements in the file), where vehicles obey only signals.
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

    static bool has_signal(const BuiltConnection& connection) { return connection.source->tl >= 0; }

    // Returns true if the connection has no signal, and SUMO's attribute `state` has this letter.
    static bool is_without_signal(const BuiltConnection& connection, char state) {
        return !has_signal(connection) && connection.source->state == state;
    }

    static StopRule stop_rule_of(char state) {
        return state == 's' ? StopRule::stop : state == 'w' ? StopRule::all_way_stop : StopRule::none;
    }

    static bool is_u_turn(const BuiltConnection& connection) { return connection.source->dir == 't'; }

    // Returns true if `connection` yields to `to`. Call this function only for a conflict that the matrix does not
    // contain, between connections with different exit lanes. Only U-turns have such conflicts, because the import
    // extends U-turns into the junction (sumo_graph.cpp). A U-turn yields to every other movement. Of two U-turns, the
    // one with the higher link number yields.
    static bool yields_at_u_turn(const BuiltConnection& connection, const BuiltConnection& to) {
        return is_u_turn(connection) && (!is_u_turn(to) || connection.link > to.link);
    }

    // Returns the right of way between two connections. If it changes with the phases of their signal, returns that of
    // the first phase, and adds the right of way of every phase to SumoNetwork::phase_priorities.
    Priority priority_of(const SumoJunction& junction, const BuiltConnection& first, const BuiltConnection& second) {
        const int tl = first.source->tl;
        if (tl < 0 || tl != second.source->tl) return priority_without_signal(junction, first, second);
        const std::vector<SumoPhase>& phases = network_.net.signals[at(tl)].phases;
        std::vector<Priority> by_phase(phases.size());
        Priority last;
        // A phase in which not both connections are green keeps the right of way of the phase before it, because
        // vehicles that entered in that phase may still be inside. The loop runs through two cycles. After the first
        // cycle, `last` is the right of way at the end of a cycle, which the first phases of the second cycle may need.
        for (std::size_t k = 0; k < 2 * phases.size(); ++k) {
            const SumoPhase& phase = phases[k % phases.size()];
            if (is_green_for_both(phase, first, second)) last = priority_in(phase, junction, first, second);
            by_phase[k % phases.size()] = last;
        }
        if (std::count(by_phase.begin(), by_phase.end(), by_phase[0]) < std::ssize(by_phase))
            network_.phase_priorities.push_back({tl, first.lane, second.lane, by_phase});
        return by_phase[0];
    }

    static bool is_green_for_both(const SumoPhase& phase, const BuiltConnection& first, const BuiltConnection& second) {
        return phase.duration_s > 0.0 && sumo_is_green(phase.state[at(first.source->tl_link)]) &&
               sumo_is_green(phase.state[at(second.source->tl_link)]);
    }

    // Returns the right of way in a phase in which both connections are green. A connection with a minor green yields
    // to one with a major green. Here a connection with the attribute `pass` counts as one with a major green. If both
    // have the same kind of green, the matrix decides, but a connection with `pass` does not yield. If these rules make
    // neither connection yield, the one with the higher link number yields.
    static Priority priority_in(const SumoPhase& phase, const SumoJunction& junction, const BuiltConnection& first,
                                const BuiltConnection& second) {
        Priority priority{!first.source->pass && !is_major(phase.state[at(first.source->tl_link)]),
                          !second.source->pass && !is_major(phase.state[at(second.source->tl_link)])};
        if (priority.first_yields != priority.second_yields) return priority;
        priority = {!first.source->pass && must_yield(junction, first, second),
                    !second.source->pass && must_yield(junction, second, first)};
        if (priority.first_yields || priority.second_yields) return priority;
        return {is_later(first, second), is_later(second, first)};
    }

    // Returns the right of way by the matrix. A connection with the attribute `pass` never yields. If the matrix makes
    // neither connection yield, a connection yields to one that has `pass` or a lower link number.
    static Priority priority_without_signal(const SumoJunction& junction, const BuiltConnection& first,
                                            const BuiltConnection& second) {
        const Priority by_matrix{must_yield(junction, first, second), must_yield(junction, second, first)};
        const bool undecided = !by_matrix.first_yields && !by_matrix.second_yields;
        const auto yields = [&](const BuiltConnection& one, const BuiltConnection& other, bool must) {
            if (one.source->pass) return false;
            return must || (undecided && (other.source->pass || is_later(one, other)));
        };
        return {yields(first, second, by_matrix.first_yields), yields(second, first, by_matrix.second_yields)};
    }

    static bool must_yield(const SumoJunction& junction, const BuiltConnection& connection, const BuiltConnection& to) {
        return bit(junction.response, connection.link, to.link);
    }

    // Returns true if `connection` has a higher link number than `to`. Two copies of one connection (see is_left_of)
    // have the same number. For two copies, returns true if `connection` is the left one.
    static bool is_later(const BuiltConnection& connection, const BuiltConnection& to) {
        return connection.link > to.link || is_left_of(connection, to);
    }

    // When a short edge is merged (sumo_short_edges.h), a connection that leaves the short edge can be copied to
    // several lanes. Returns true if `connection` and `other` are two copies of one connection, and `connection` begins
    // further left.
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

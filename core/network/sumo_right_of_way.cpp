#include "network/sumo_right_of_way.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <unordered_map>

#include <fmt/format.h>

#include "network/conflicts.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

bool bit(const std::vector<std::vector<bool>>& matrix, int row, int column) {
    return row >= 0 && column >= 0 && at(row) < matrix.size() && at(column) < matrix.size() &&
           matrix[at(row)][at(column)];
}

bool is_major(char letter) { return letter == 'G' || letter == 'O'; }

class Finder {
public:
    Finder(SumoNetwork& made, std::vector<SumoWay>& ways, double clearance_m)
        : made_(made), ways_(ways), clearance_m_(clearance_m) {}

    void find() {
        made_.graph.conflicts.assign(made_.graph.lanes.size(), {});
        count_links_without_via();
        std::vector<std::vector<int>> of_junction(made_.net.junctions.size());
        for (std::size_t k = 0; k < ways_.size(); ++k) {
            if (ways_[k].junction >= 0) of_junction[at(ways_[k].junction)].push_back(static_cast<int>(k));
        }
        for (std::size_t junction = 0; junction < of_junction.size(); ++junction) {
            const std::vector<int>& ways = of_junction[junction];
            if (made_.net.junctions[junction].response.empty()) note_free_for_all(made_.net.junctions[junction], ways);
            for (std::size_t one = 0; one < ways.size(); ++one) {
                for (std::size_t two = one + 1; two < ways.size(); ++two) {
                    add(made_.net.junctions[junction], ways_[at(ways[one])], ways_[at(ways[two])]);
                }
            }
        }
        for (SumoWay& way : ways_) {
            const bool known = way.junction >= 0 && way.link >= 0;
            const std::vector<bool> none;
            const std::vector<bool>& cont = known ? made_.net.junctions[at(way.junction)].cont : none;
            lane(way).waits_inside = known && at(way.link) < cont.size() && cont[at(way.link)];
            std::vector<Conflict>& all = made_.graph.conflicts[at(way.lane)];
            std::stable_sort(all.begin(), all.end(),
                             [](const Conflict& a, const Conflict& b) { return a.from_m < b.from_m; });
            if (all.empty()) lane(way).keeps_clear = false;
        }
    }

private:
    Lane& lane(const SumoWay& way) { return made_.graph.lanes[at(way.lane)]; }

    // In networks without internal lanes links are counted by lane that leads to the junction, and then in the order of the file.
    void count_links_without_via() {
        std::unordered_map<std::string, std::vector<SumoWay*>> from;
        for (SumoWay& way : ways_) {
            if (way.connection->via < 0) from[made_.graph.lanes[at(lane(way).origin)].name].push_back(&way);
        }
        for (std::size_t junction = 0; junction < made_.net.junctions.size() && !from.empty(); ++junction) {
            int link = 0;
            for (const std::string& incoming : made_.net.junctions[junction].incoming) {
                const auto found = from.find(incoming);
                if (found == from.end()) continue;
                for (SumoWay* way : found->second) {
                    way->junction = static_cast<int>(junction);
                    way->link = link++;
                }
            }
        }
    }

    void add(const SumoJunction& junction, const SumoWay& one, const SumoWay& two) {
        const Lane& a = lane(one);
        const Lane& b = lane(two);
        const bool foes = bit(junction.foes, one.link, two.link) || bit(junction.foes, two.link, one.link);
        const bool turning_round = turns_round(one) || turns_round(two);
        if (a.origin == b.origin || (!foes && a.next != b.next && !turning_round)) return;
        const std::optional<Conflict> c = conflict_of(a, b, clearance_m_);
        if (!c) return;
        const bool known = foes || a.next == b.next;
        const bool one_yields = known ? yields(junction, one, two) : yields_turning(one, two);
        const bool two_yields = known ? yields(junction, two, one) : yields_turning(two, one);
        made_.graph.conflicts[at(one.lane)].push_back(
            {two.lane, c->from_m, c->to_m, c->other_from_m, c->other_to_m, one_yields, two_yields});
        made_.graph.conflicts[at(two.lane)].push_back(
            {one.lane, c->other_from_m, c->other_to_m, c->from_m, c->to_m, two_yields, one_yields});
    }

    // Without requests no ways are foes; lights, if there are any, are minded.
    void note_free_for_all(const SumoJunction& junction, const std::vector<int>& ways) {
        for (const int one : ways) {
            for (const int two : ways) {
                const Lane& a = lane(ways_[at(one)]);
                const Lane& b = lane(ways_[at(two)]);
                if (one >= two || a.origin == b.origin || a.next == b.next || !conflict_of(a, b, clearance_m_))
                    continue;
                made_.net.warnings.note(
                    junction.where,
                    fmt::format(
                        "junction '{}' of type '{}' has no requests: nobody gives way there, and vehicles whose "
                        "ways cross drive through each other",
                        junction.id, junction.type));
                return;
            }
        }
    }

    static bool turns_round(const SumoWay& way) { return way.connection->dir == 't'; }

    // Of two that are no foes in the matrix but meet, since one turns round further ahead here (sumo_graph.cpp).
    static bool yields_turning(const SumoWay& way, const SumoWay& to) {
        return turns_round(way) && (!turns_round(to) || way.link > to.link);
    }

    // Lights that are green together: those of one programme by its phases, of others possibly.
    bool yields(const SumoJunction& junction, const SumoWay& way, const SumoWay& to) const {
        if (way.connection->pass) return false;
        const bool asked = bit(junction.response, way.link, to.link);
        const int tl = way.connection->tl;
        if (tl < 0 || tl != to.connection->tl) {
            // Where nobody is asked to wait, the later link does.
            const bool nobody = !asked && !bit(junction.response, to.link, way.link);
            return asked || (nobody && (to.connection->pass || way.link > to.link || is_left_of(way, to)));
        }
        bool together = false;
        bool minor = false;
        bool major = false;
        for (const SumoPhase& phase : made_.net.signals[at(tl)].phases) {
            const char own = phase.state[at(way.connection->tl_link)];
            const char other = phase.state[at(to.connection->tl_link)];
            if (phase.duration_s <= 0.0 || !sumo_is_green(own) || !sumo_is_green(other)) continue;
            together = true;
            minor = minor || (!is_major(own) && is_major(other));
            major = major || (is_major(own) && !is_major(other));
        }
        const bool later = junction.response.empty() && !major && way.link > to.link;
        return together && (minor || asked || later || is_left_of(way, to));
    }

    // Two lanes that an edge that was joined to theirs made one (sumo_short_edges.h): the left one gives way.
    static bool is_left_of(const SumoWay& way, const SumoWay& other) {
        const SumoConnection& own = *way.connection;
        const SumoConnection& its = *other.connection;
        return own.via >= 0 && own.via == its.via && own.via_lane == its.via_lane && own.from_lane > its.from_lane;
    }

    SumoNetwork& made_;
    std::vector<SumoWay>& ways_;
    double clearance_m_;
};

}  // namespace

void find_sumo_conflicts(SumoNetwork& made, std::vector<SumoWay>& ways, double clearance_m) {
    Finder(made, ways, clearance_m).find();
}

}  // namespace stopline

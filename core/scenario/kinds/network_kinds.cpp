// The list of kinds of networks.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/defined_elsewhere.h"
#include "base/input_error.h"
#include "scenario/kinds/network_kind.h"

namespace stopline {

// Returns the kinds. The order is the order in lists for the user.
static std::vector<const NetworkKind*>& kinds() {
    static std::vector<const NetworkKind*> all{
        // NOLINTBEGIN(readability-identifier-naming): the macro declares constants of the namespace inside a function.
        STOPLINE_DEFINED_ELSEWHERE(NetworkKind, kApproachKind),
        STOPLINE_DEFINED_ELSEWHERE(NetworkKind, kIntersectionKind),
        STOPLINE_DEFINED_ELSEWHERE(NetworkKind, kGridKind),
        STOPLINE_DEFINED_ELSEWHERE(NetworkKind, kStreetsKind),
        STOPLINE_DEFINED_ELSEWHERE(NetworkKind, kSumoKind),
        // NOLINTEND(readability-identifier-naming)
    };
    return all;
}

std::span<const NetworkKind* const> network_kinds() { return kinds(); }

void register_network_kind(const NetworkKind& kind) { kinds().push_back(&kind); }

const NetworkKind& network_kind(const NetworkSettings& network) {
    for (const NetworkKind* kind : kinds()) {
        if (network.kind == kind->name) return *kind;
    }
    throw InputError(fmt::format("there is no kind of network '{}'; the kinds are: {}", network.kind,
                                 fmt::join(kinds_with([](const NetworkKind&) { return true; }), ", ")));
}

NominalCycle Scenario::nominal_cycle() const {
    const NetworkKind& kind = network_kind(network);
    return kind.nominal_cycle != nullptr ? kind.nominal_cycle(*this)
                                         : stopline::nominal_cycle(signal, kind.signal_groups);
}

double Scenario::end_s() const {
    if (duration_s != 0.0) return duration_s;
    return signal.first_green_s + (measure.warmup_cycles + measure.cycles) * nominal_cycle().cycle_s;
}

LaneGraph make_network(const NetworkSettings& network) { return network_kind(network).graph(network); }

double end_of_lane_m(const Lane& lane) { return lane.signal_group >= 0 ? lane.stop_line_m : lane.length_m; }

double loop_position_m(const LoopSettings& loop, const Lane& lane) {
    return loop.position_m < 0.0 ? end_of_lane_m(lane) + loop.position_m : loop.position_m;
}

double radius_beyond_m(const NetworkSettings& network, const Lane& lane) {
    const NetworkKind& kind = network_kind(network);
    return kind.radius_beyond_m == nullptr ? 0.0 : kind.radius_beyond_m(network, lane);
}

}  // namespace stopline

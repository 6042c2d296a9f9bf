#include "signals/street_phases.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "signals/signal_controller.h"

namespace stopline {

namespace {

// The names of the signal groups of an intersection, in the order of make_streets().
const std::array<std::string, 3> kStreetGroups{"major", "left", "minor"};

// Returns true if `holds` is true for an approach lane of the major or of the minor street.
template <class Condition>
bool any_lane(const StreetIntersection& intersection, bool major, const Condition& holds) {
    return std::any_of(intersection.legs.begin(), intersection.legs.end(), [&](const StreetLeg& leg) {
        const bool is_major = leg.from == "west" || leg.from == "east";
        return is_major == major && std::any_of(leg.lanes.begin(), leg.lanes.end(), holds);
    });
}

bool has_lanes(const StreetIntersection& intersection, bool major) {
    return any_lane(intersection, major, [](const StreetLane& /*lane*/) { return true; });
}

bool has_protected_left(const StreetIntersection& intersection) {
    return intersection.programme.protected_left_s > 0.0 &&
           any_lane(intersection, true, [](const StreetLane& lane) { return lane.movements == "left"; });
}

PhaseSettings street_phase(const std::string& group, double green_s, double yellow_s, double clearance_s) {
    PhaseSettings phase;
    phase.protected_movements = {group};
    phase.green_s = green_s;
    phase.yellow_s = yellow_s;
    phase.all_red_s = clearance_s;
    phase.min_green_s = std::min(phase.min_green_s, green_s);
    return phase;
}

// Adds the phase of a street. Pedestrians have no detectors, so their green lasts as long as in the programme.
void add_street_phase(PhaseSettings phase, bool has_lanes, std::vector<PhaseSettings>& phases) {
    if (!has_lanes && phase.green_s <= 0.0) return;
    if (!has_lanes) phase.recall = "maximum";
    phases.push_back(std::move(phase));
}

}  // namespace

std::vector<PhaseSettings> make_street_phases(const StreetIntersection& intersection) {
    const SevenSteps& steps = intersection.programme;
    const bool has_left = has_protected_left(intersection);
    std::vector<PhaseSettings> phases;
    PhaseSettings major = street_phase("major", steps.major_green_s, steps.major_yellow_s, steps.major_clearance_s);
    if (has_left) major.permissive_movements = {"left"};
    add_street_phase(std::move(major), has_lanes(intersection, true), phases);
    if (has_left) {
        phases.push_back(street_phase("left", steps.protected_left_s, steps.major_yellow_s, steps.major_clearance_s));
    }
    add_street_phase(street_phase("minor", steps.minor_green_s, steps.minor_yellow_s, steps.minor_clearance_s),
                     has_lanes(intersection, false), phases);
    return phases;
}

SignalPlan make_street_signal_plan(const SignalSettings& settings, const StreetIntersection& intersection,
                                   int first_group, double step_s) {
    const auto programmes = make_seven_steps(intersection.programme, intersection.offset_s, step_s);
    SignalSettings own = settings;
    own.first_green_s = 0.0;
    own.phases = make_street_phases(intersection);
    if (own.phases.empty()) return fixed_time_plan(first_group, {programmes.begin(), programmes.end()});
    SignalPlan plan = make_signal_plan(own, first_group, {programmes.begin(), programmes.end()}, step_s);
    plan.phases = make_phase_plan(own, kStreetGroups, step_s);
    for (const PhaseSettings& phase : own.phases) {
        RingPhase protection;
        for (std::size_t k = 0; k < kStreetGroups.size(); ++k) {
            if (has_protected_green(phase, kStreetGroups[k])) protection.protected_groups |= std::uint64_t{1} << k;
        }
        plan.phases.rings.phases.push_back(protection);
    }
    return plan;
}

}  // namespace stopline

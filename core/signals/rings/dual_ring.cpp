// The dual-ring controller (NEMA TS 2; FHWA, Signal Timing Manual, second edition, chapters 4 to 7). Its phases run in
// two rings. A green lasts at least its minimum. It then ends for another phase with a call at a gap in the traffic or
// at its maximum. Phases without a call are skipped.
//
// - Within a side of the barriers each ring goes on by itself, in the order of the file.
// - Both rings leave a side in the same tick, when both greens may end (simultaneous gap-out). The next side begins
//   when both rings are cleared. A ring cannot return to an earlier phase within a side. If such a phase has a call and
//   the other side has none, both rings begin the same side again.
// - A lane calls the phases that protect all its movements. Without such a phase it calls those with green for all of
//   them, else those that protect one of them, else those with green for one of them. The lanes that call a phase also
//   extend its green.
//
// Coordination. Each ring has one coordinated phase. It holds its green up to its yield point in the background cycle.
// Another phase gets green only if its minimum fits in before its force-off point. Its green lasts at most its green
// time (floating force-off), so the time that it leaves goes to the coordinated phases.
#include <algorithm>

#include <fmt/format.h>

#include "signals/actuation.h"
#include "signals/rings/ring_memory.h"
#include "signals/rings/ring_problems.h"
#include "signals/signal_controller.h"

namespace stopline {

namespace {

class DualRingSignal {
public:
    explicit DualRingSignal(SignalView& view)
        : view_(view), plan_(view.plan().phases), rings_(plan_.rings), memory_(view.memory(), plan_) {}

    void reset() {
        for (std::size_t ring = 0; ring < kRings; ++ring) {
            set(ring, RingInterval::red);
            at(ring, kCurrentPhase) = at(ring, kFollowingPhase) = at(ring, kLastPlace) = -1;
        }
        for (int group = 0; group < view_.groups(); ++group) memory_.green_end(group) = -1;
    }

    // Sets the lights of the present tick.
    void step() {
        if (memory_.has_begun() == 0) return begin_run();
        for (std::size_t ring = 0; ring < kRings; ++ring) clear(ring);
        if (memory_.is_crossing() != 0) {
            if (interval(0) == RingInterval::red && interval(1) == RingInterval::red) begin_side();
            return;
        }
        for (std::size_t ring = 0; ring < kRings; ++ring) enter_from_red(ring);
        for (std::size_t ring = 0; ring < kRings; ++ring) go_on(ring);
        cross();
    }

private:
    static std::size_t index(int number) { return static_cast<std::size_t>(number); }
    std::int64_t& at(std::size_t ring, std::size_t number) { return memory_.at(ring, number); }
    std::int64_t at(std::size_t ring, std::size_t number) const { return memory_.at(ring, number); }
    RingInterval interval(std::size_t ring) const { return memory_.interval(ring); }
    int current(std::size_t ring) const { return memory_.current(ring); }
    int following(std::size_t ring) const { return memory_.following(ring); }
    int side() const { return static_cast<int>(memory_.side()); }
    const SignalPhase& phase(int number) const { return memory_.phase(number); }
    const RingPhase& in_ring(int number) const { return rings_.phases[index(number)]; }
    bool is_imported() const { return !view_.plan().lane_detectors.empty(); }
    bool is_decision() const { return view_.tick() % decision_ticks(view_.plan()) == 0; }
    bool is_coordinated(int number) const { return rings_.is_coordinated() && in_ring(number).is_coordinated; }
    bool has_green(std::size_t ring) const { return memory_.has_green(ring); }
    bool is_green(int number) const {
        const std::size_t ring = in_ring(number).ring;
        return has_green(ring) && current(ring) == number;
    }
    static std::uint64_t bit(int group) { return std::uint64_t{1} << group; }

    void set(std::size_t ring, RingInterval interval) {
        at(ring, kRingInterval) = static_cast<std::int64_t>(interval);
        at(ring, kIntervalStart) = view_.tick();
    }

    // --- Lights ---------------------------------------------------------------------------------------------------

    void begin_run() {
        memory_.has_begun() = 1;
        const int target = rings_.is_coordinated() ? coordinated_side() : first_called_side();
        memory_.side() = target;
        for (std::size_t ring = 0; ring < kRings; ++ring) {
            const auto& order = rings_.order[ring][index(target)];
            int next = rings_.is_coordinated() ? rings_.coordinated[ring] : entering_phase(ring, target, 0);
            if (next < 0 && !order.empty()) next = order.front();
            at(ring, kFollowingPhase) = next;
        }
        begin_side();
    }

    int coordinated_side() const { return in_ring(std::max(rings_.coordinated[0], rings_.coordinated[1])).side; }

    int first_called_side() const {
        for (int number = 0; number < rings_.sides(); ++number) {
            if (has_call_on(number, 0)) return number;
        }
        return 0;
    }

    void begin_side() {
        memory_.is_crossing() = 0;
        for (std::size_t ring = 0; ring < kRings; ++ring) {
            at(ring, kCurrentPhase) = -1;
            at(ring, kLastPlace) = -1;
        }
        for (std::size_t ring = 0; ring < kRings; ++ring) {
            if (following(ring) >= 0) {
                memory_.side() = in_ring(following(ring)).side;
                begin_green(ring, following(ring));
            }
        }
    }

    void begin_green(std::size_t ring, int number) {
        set(ring, RingInterval::green);
        at(ring, kCurrentPhase) = number;
        at(ring, kFollowingPhase) = -1;
        at(ring, kLastPlace) = in_ring(number).place;
        at(ring, kMaximumStart) = is_imported() ? view_.tick() : -1;
        at(ring, kExtension) = -1;
        if (rings_.is_coordinated())
            at(ring, kPoint) = view_.tick() + rings_.ticks_to(in_ring(number).force_off, view_.tick());
        for (int group = 0; group < view_.groups(); ++group) show_green_of(ring, group);
        const int pair = rings_.pair({{current(0), current(1)}});
        if (pair >= 0) view_.begin_phase(pair);
    }

    // Shows green if the phase of the ring has green for the group and the other ring is not clearing it.
    void show_green_of(std::size_t ring, int group) {
        if (!phase(current(ring)).has_green(group) || is_clearing(1 - ring, group)) return;
        view_.show(group, Light::green);
    }
    bool is_clearing(std::size_t ring, int group) const { return memory_.is_clearing(ring, group); }

    void begin_yellow(std::size_t ring, int next) {
        at(ring, kFollowingPhase) = next;
        set(ring, RingInterval::yellow);
        for (int group = 0; group < view_.groups(); ++group) {
            if (!phase(current(ring)).has_green(group) || view_.light(group) != Light::green) continue;
            if (keeps_green(0, group) || keeps_green(1, group)) continue;
            if (view_.green_start_tick(group) == view_.tick()) {  // it would show yellow without a green before
                view_.show(group, Light::red);
                continue;
            }
            at(ring, kClearing) |= static_cast<std::int64_t>(bit(group));
            view_.show(group, Light::yellow);
            memory_.green_end(group) = view_.tick();
        }
        clear(ring);
    }

    // Returns true if the ring has green for the group now, and in its next phase if the present phase is ending.
    bool keeps_green(std::size_t ring, int group) const {
        if (!memory_.serves(ring, group)) return false;
        if (has_green(ring)) return true;
        return following(ring) >= 0 && phase(following(ring)).has_green(group);
    }

    // Ends yellow and red times that are over.
    void clear(std::size_t ring) {
        if (interval(ring) == RingInterval::yellow && elapsed(ring) >= phase(current(ring)).yellow_ticks) {
            set(ring, RingInterval::all_red);
            for (int group = 0; group < view_.groups(); ++group) {
                if (is_clearing(ring, group)) view_.show(group, Light::red);
            }
        }
        if (interval(ring) != RingInterval::all_red || elapsed(ring) < phase(current(ring)).all_red_ticks) return;
        const auto cleared = static_cast<std::uint64_t>(at(ring, kClearing));
        at(ring, kClearing) = 0;
        for (int group = 0; group < view_.groups(); ++group) {
            if ((cleared & bit(group)) != 0 && has_green(1 - ring)) show_green_of(1 - ring, group);
        }
        if (memory_.is_crossing() != 0) {
            set(ring, RingInterval::red);
        } else {
            begin_green(ring, following(ring));
        }
    }

    std::int64_t elapsed(std::size_t ring) const { return view_.tick() - at(ring, kIntervalStart); }
    std::int64_t clearance(std::size_t ring) const {
        if (!has_green(ring)) return 0;
        return phase(current(ring)).yellow_ticks + phase(current(ring)).all_red_ticks;
    }

    // --- Sequence ---------------------------------------------------------------------------------------------------

    // Begins a phase in a ring that is red, while the other ring has green.
    void enter_from_red(std::size_t ring) {
        if (interval(ring) != RingInterval::red) return;
        const int next = later_phase(ring, 0);
        if (next >= 0) begin_green(ring, next);
    }

    void go_on(std::size_t ring) {
        if (!has_green(ring)) return;
        if (is_decision() && is_occupied(current(ring))) at(ring, kExtension) = view_.tick();
        const int next = later_phase(ring, clearance(ring));
        if (next < 0 && crossing_target() < 0) return rest(ring);
        if (at(ring, kMaximumStart) < 0) at(ring, kMaximumStart) = view_.tick();
        if (next >= 0 && may_end(ring)) begin_yellow(ring, next);
    }

    // The maximum green of the phase begins with the next call. SUMO's maximum begins with the green, and again with
    // the minimum green while both rings rest.
    void rest(std::size_t ring) {
        if (!is_imported()) {
            at(ring, kMaximumStart) = -1;
        } else if (may_end(0) && may_end(1)) {
            at(ring, kMaximumStart) = view_.tick() - phase(current(ring)).min_green_ticks;
        }
    }

    // Ends the greens of both rings if both may end for another side.
    void cross() {
        for (std::size_t ring = 0; ring < kRings; ++ring) {
            if (interval(ring) == RingInterval::yellow || interval(ring) == RingInterval::all_red) return;
            if (later_phase(ring, clearance(ring)) >= 0 || !may_end(ring)) return;
        }
        const int target = crossing_target();
        if (target < 0) return;
        const std::int64_t start = view_.tick() + crossing_ticks();
        std::array<int, kRings> next{};
        for (std::size_t ring = 0; ring < kRings; ++ring) next[ring] = entering_phase(ring, target, start);
        memory_.is_crossing() = 1;
        for (std::size_t ring = 0; ring < kRings; ++ring) at(ring, kFollowingPhase) = next[ring];
        std::array<bool, kRings> ends{has_green(0), has_green(1)};
        // Both greens end at once: neither ring keeps the green of a group for the other one.
        for (std::size_t ring = 0; ring < kRings; ++ring) {
            if (ends[ring]) set(ring, RingInterval::yellow);
        }
        for (std::size_t ring = 0; ring < kRings; ++ring) {
            if (ends[ring]) begin_yellow(ring, next[ring]);
        }
        if (interval(0) == RingInterval::red && interval(1) == RingInterval::red) begin_side();
    }

    std::int64_t crossing_ticks() const { return std::max(clearance(0), clearance(1)); }

    // Returns the next phase of the ring on the present side that can begin after the clearance; -1: none.
    int later_phase(std::size_t ring, std::int64_t clearance_ticks) const {
        const auto& order = rings_.order[ring][index(side())];
        for (std::size_t k = index(static_cast<int>(at(ring, kLastPlace)) + 1); k < order.size(); ++k) {
            if (can_begin(order[k], view_.tick() + clearance_ticks)) return order[k];
        }
        return -1;
    }

    // Returns the next side with a phase that can begin: another side, or the present one if a phase whose turn is over
    // has a call; -1: none.
    int crossing_target() const {
        const std::int64_t start = view_.tick() + crossing_ticks();
        for (int k = 1; k < rings_.sides(); ++k) {
            const int target = (side() + k) % rings_.sides();
            if (has_call_on(target, start)) return target;
        }
        for (std::size_t ring = 0; ring < kRings; ++ring) {
            for (const int number : rings_.order[ring][index(side())]) {
                const bool is_over = in_ring(number).place <= at(ring, kLastPlace);
                if (is_over && !is_green(number) && can_begin(number, start)) return side();
            }
        }
        return -1;
    }

    bool has_call_on(int target, std::int64_t start) const {
        return std::any_of(rings_.order.begin(), rings_.order.end(), [&](const auto& order) {
            const auto& phases = order[index(target)];
            return std::any_of(phases.begin(), phases.end(), [&](int number) { return can_begin(number, start); });
        });
    }

    // Returns the phase with which the ring begins a side; -1: none.
    int entering_phase(std::size_t ring, int target, std::int64_t start) const {
        const auto& order = rings_.order[ring][index(target)];
        for (const int number : order) {
            if (can_begin(number, start)) return number;
        }
        for (const int number : order) {
            if (in_ring(number).has_dual_entry && fits(number, start)) return number;
        }
        return -1;
    }

    // Returns true if the phase has a call and its green can begin at the tick `start`.
    bool can_begin(int number, std::int64_t start) const { return fits(number, start) && has_call(number); }

    // Returns true if the minimum green of the phase fits in before its force-off point, and this point lies before the
    // next green of the coordinated phase. The coordinated phase itself can begin at any time.
    bool fits(int number, std::int64_t start) const {
        if (!rings_.is_coordinated() || in_ring(number).is_coordinated) return true;
        const std::size_t ring = in_ring(number).ring;
        const RingPhase& coordinated = in_ring(rings_.coordinated[rings_.coordinated[ring] >= 0 ? ring : 1 - ring]);
        if (!is_between_greens(coordinated, start)) return false;
        const std::int64_t to_force_off = rings_.ticks_to(in_ring(number).force_off, start);
        return to_force_off >= phase(number).min_green_ticks &&
               to_force_off <= rings_.ticks_to(coordinated.start_point, start);
    }

    // Returns true if the present phase of the ring may end. A ring without a phase need not wait.
    bool may_end(std::size_t ring) const {
        if (!has_green(ring)) return true;
        const SignalPhase& own = phase(current(ring));
        const std::int64_t shown = elapsed(ring);
        if (shown < own.min_green_ticks || !is_decision()) return false;
        if (is_coordinated(current(ring))) return may_yield(ring);
        const bool has_gap = own.recall != Recall::maximum && gap_has_passed(ring);
        if (rings_.is_coordinated()) return has_gap || shown >= own.green_ticks || view_.tick() >= at(ring, kPoint);
        const std::int64_t maximum = std::max(own.max_green_ticks, own.min_green_ticks);
        if (own.recall == Recall::maximum) return shown >= maximum;
        return has_gap || (at(ring, kMaximumStart) >= 0 && view_.tick() - at(ring, kMaximumStart) >= maximum);
    }

    bool may_yield(std::size_t ring) const {
        return view_.tick() >= at(ring, kPoint) && is_between_greens(in_ring(current(ring)), view_.tick());
    }

    // Returns true between the yield point of the coordinated phase and the latest start of its next green.
    bool is_between_greens(const RingPhase& coordinated, std::int64_t tick) const {
        const std::int64_t to_start = rings_.ticks_to(coordinated.start_point, tick);
        const std::int64_t longest = coordinated.start_point - coordinated.force_off + rings_.cycle_ticks;
        return to_start > 0 && to_start <= longest;
    }

    // --- Detectors --------------------------------------------------------------------------------------------------

    // Returns true if no vehicle has extended the green for the gap. Imported signals see vehicles at decisions only.
    bool gap_has_passed(std::size_t ring) const {
        const int number = current(ring);
        if (is_imported())
            return at(ring, kExtension) < 0 || view_.tick() - at(ring, kExtension) >= phase(number).gap_ticks;
        const auto detectors = view_.detectors();
        return std::none_of(detectors.begin(), detectors.end(), [&](const SignalDetector& detector) {
            return detector.last_occupied_tick >= 0 &&
                   view_.tick() - detector.last_occupied_tick < phase(number).gap_ticks && is_used(detector) &&
                   belongs_to_phase(view_.plan(), detector, number);
        });
    }

    // Returns true if a vehicle covers a detector of an imported phase.
    bool is_occupied(int number) const {
        const auto detectors = view_.detectors();
        return is_imported() && std::any_of(detectors.begin(), detectors.end(), [&](const SignalDetector& detector) {
                   return detector.is_occupied && belongs_to_phase(view_.plan(), detector, number);
               });
    }

    bool has_call(int number) const {
        if (phase(number).recall != Recall::off || is_coordinated(number)) return true;
        const auto detectors = view_.detectors();
        return std::any_of(detectors.begin(), detectors.end(), [&](const SignalDetector& detector) {
            return is_waiting(detector) && belongs_to_phase(view_.plan(), detector, number);
        });
    }

    // Returns true if a vehicle waits at the stop line, or has passed the upstream detector while the lane was red.
    bool is_waiting(const SignalDetector& detector) const {
        if (is_at(view_.plan(), detector, kStopDetector)) return detector.is_occupied;
        if (!is_at(view_.plan(), detector, kAdvanceDetector)) return false;
        std::int64_t last_end = -1;
        for (int group = 0; group < view_.groups(); ++group) {
            if ((detector.groups & bit(group)) == 0) continue;
            if (view_.light(group) == Light::green) return false;
            last_end = std::max(last_end, memory_.green_end(group));
        }
        return detector.last_crossing_tick > last_end;
    }

    bool is_used(const SignalDetector& detector) const {
        return is_at(view_.plan(), detector, kStopDetector) || is_at(view_.plan(), detector, kAdvanceDetector);
    }

    SignalView& view_;
    const PhasePlan& plan_;
    const RingPlan& rings_;
    RingMemory memory_;
};

std::int64_t start_rings(SignalView& view) {
    DualRingSignal signal(view);
    signal.reset();
    const std::int64_t first_tick = to_ticks(view.plan().settings.first_green_s, view.plan().step_s);
    if (first_tick > view.tick()) return first_tick;
    signal.step();
    return view.tick() + 1;
}

std::int64_t step_rings(SignalView& view) {
    DualRingSignal(view).step();
    return view.tick() + 1;
}

NominalCycle nominal_ring_cycle(const SignalSettings& settings, int /*groups*/) {
    if (!settings.has_phases()) return {settings.intersection_cycle_s(), settings.green_s};
    NominalCycle nominal{settings.cycle_s > 0.0 ? settings.cycle_s : ring_cycle_s(settings), 0.0};
    for (const PhaseSettings& phase : settings.phases)
        nominal.longest_green_s = std::max(nominal.longest_green_s, phase.green_s);
    return nominal;
}

}  // namespace

extern const SignalController kDualRingController{
    .name = "dual_ring",
    .meaning =
        "phases in two rings with barriers (NEMA): as actuated, but one phase of each ring at a time; with "
        "signal.cycle, they are coordinated",
    .parameters = kActuationParameters,
    .nominal_cycle = nominal_ring_cycle,
    .init = start_rings,
    .step = step_rings,
    .next_green = next_ring_green,
    .memory_size = [](const SignalPlan& plan) { return RingMemory::size(plan.groups.size()); },
    .detectors_m = actuation_detectors_m,
    .problems = ring_problems,
    .runs_phases = true,
    .runs_rings = true};

}  // namespace stopline

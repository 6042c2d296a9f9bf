// The actuated controller: it runs the phases of the signal in their order and skips phases without a call. The green
// of a phase lasts at least its minimum. It then ends when another phase has a call, and either no detector of the
// phase has been occupied for the gap, or its maximum has passed since the first call of another phase. Without a call
// of another phase, the green goes on. Yellow and all-red times are constant.
//
// Each approach lane has two detectors (signals/actuation.h). A lane has a call while a vehicle covers the one at the
// stop line, and from the tick at which a vehicle passes the other one at red. The call of a lane with several
// movements belongs to the phases that give green to all of them. If there are none, it belongs to the phases that give
// green to one of them.
//
// If PhasePlan::rings says which groups each phase protects, as for streets, a lane calls and extends the phases that
// serve it best (belongs_to_phase()). It calls a phase that protects it even while it has a permissive green. A group
// gets yellow and red between a permissive and a protected green.
//
// With `platoon_range`, platoons announce by V2V when their rear will pass the stop line. The green then lasts until
// the rear of the platoon has passed, if this is before the maximum. Otherwise the green ends while the whole platoon
// can still stop. So the green ends between two platoons, or between two mini-platoons if the length of platoons is
// limited. A platoon of which some vehicles cannot stop any more keeps the green until the maximum.
#include <algorithm>

#include <fmt/format.h>

#include "signals/actuation.h"
#include "signals/phase_lights.h"
#include "signals/signal_controller.h"

namespace stopline {

namespace {

enum class Interval : std::uint8_t { initial_red, green, yellow, all_red };

// Indices in the memory of the controller. The ticks at which the groups last lost green follow (kGreenEnds + group).
// kMaximumFrom: tick of the first call of another phase during the present green; -1: none.
constexpr std::size_t kInterval = 0;
constexpr std::size_t kPhase = 1;
constexpr std::size_t kNextPhase = 2;
constexpr std::size_t kStartTick = 3;
constexpr std::size_t kMaximumFrom = 4;
constexpr std::size_t kGreenEnds = 5;

// Index in SignalPlan::values, after those of signals/actuation.h.
constexpr std::size_t kPlatoonRange = 2;
constexpr std::array kActuatedParameters{
    kStopDetectorParameter, kAdvanceDetectorParameter,
    SignalParameter{"platoon_range", "m", 0, 1000, "0 m",
                    "distance from the stop line within which platoons announce by V2V when their rear will pass; a "
                    "green lasts until then if its maximum allows, else it ends before the platoon; 0 m: off"}};

class ActuatedSignal {
public:
    explicit ActuatedSignal(SignalView& view) : view_(view), plan_(view.plan().phases), memory_(view.memory()) {}

    void reset() {
        memory_[kInterval] = static_cast<std::int64_t>(Interval::initial_red);
        memory_[kPhase] = memory_[kNextPhase] = -1;
        for (int group = 0; group < view_.groups(); ++group) green_end(group) = -1;
    }

    // Sets the lights of the present tick. Returns the tick of the next decision.
    std::int64_t step() {
        switch (static_cast<Interval>(memory_[kInterval])) {
            case Interval::initial_red:
                return begin_green(first_phase());
            case Interval::green:
                return decide_green();
            case Interval::yellow:
                return begin_all_red();
            case Interval::all_red:
                break;
        }
        return begin_green(static_cast<int>(memory_[kNextPhase]));
    }

    // Returns the green that is certain to come or to last. A later green depends on the traffic.
    GreenWindow next_green(int group, std::int64_t after_tick) const {
        const auto interval = static_cast<Interval>(memory_[kInterval]);
        const std::int64_t now = view_.tick();
        GreenWindow green;
        if (view_.light(group) == Light::green) {
            green.from_tick = view_.green_start_tick(group);
            green.until_tick = now + 1;
            if (interval == Interval::green) {
                green.until_tick = std::max(green.until_tick, memory_[kStartTick] + shortest_green(present()));
            }
        } else if (interval == Interval::yellow || interval == Interval::all_red) {
            const int next = static_cast<int>(memory_[kNextPhase]);
            if (!phase(next).has_green(group)) return {};
            const SignalPhase& own = phase(present());
            const std::int64_t rest =
                interval == Interval::yellow ? own.yellow_ticks + own.all_red_ticks : own.all_red_ticks;
            green.from_tick = memory_[kStartTick] + rest;
            green.until_tick = green.from_tick + shortest_green(next);
        }
        return green.is_known() && green.until_tick > after_tick ? green : GreenWindow{};
    }

private:
    std::int64_t shortest_green(int number) const {
        const SignalPhase& own = phase(number);
        return own.recall == Recall::maximum ? std::max(own.max_green_ticks, own.min_green_ticks) : own.min_green_ticks;
    }
    const SignalPhase& phase(int number) const { return plan_.phases[static_cast<std::size_t>(number)]; }
    bool knows_protection() const { return !plan_.rings.phases.empty(); }
    std::uint64_t protected_groups(int number) const {
        return plan_.rings.phases[static_cast<std::size_t>(number)].protected_groups;
    }
    int present() const { return static_cast<int>(memory_[kPhase]); }
    std::int64_t& green_end(int group) { return memory_[kGreenEnds + static_cast<std::size_t>(group)]; }

    void begin_interval(Interval interval) {
        memory_[kInterval] = static_cast<std::int64_t>(interval);
        memory_[kStartTick] = view_.tick();
    }

    std::int64_t begin_green(int next) {
        begin_interval(Interval::green);
        memory_[kPhase] = next;
        memory_[kMaximumFrom] = -1;
        show_phase(view_, next);
        if (called_phase() >= 0) memory_[kMaximumFrom] = view_.tick();
        return view_.tick() + 1;
    }

    std::int64_t decide_green() {
        const int next = called_phase();
        if (next < 0) {
            memory_[kMaximumFrom] = -1;
            return view_.tick() + 1;
        }
        if (memory_[kMaximumFrom] < 0) memory_[kMaximumFrom] = view_.tick();
        return may_end_green() ? begin_yellow(next) : view_.tick() + 1;
    }

    // Returns true if the present green may end in favour of another phase.
    bool may_end_green() const {
        const SignalPhase& own = phase(present());
        const std::int64_t shown = view_.tick() - memory_[kStartTick];
        if (own.green_groups == 0) return shown >= own.green_ticks;  // pedestrians
        const std::int64_t maximum = std::max(own.max_green_ticks, own.min_green_ticks);
        if (own.recall == Recall::maximum) return shown >= maximum;
        if (shown < own.min_green_ticks) return false;
        if (view_.tick() - memory_[kMaximumFrom] >= maximum) return true;
        if (shown % decision_ticks(view_.plan()) != 0) return false;
        const auto detectors = view_.detectors();
        return std::none_of(detectors.begin(), detectors.end(), [&](const SignalDetector& detector) {
            const bool is_own = knows_protection() ? belongs_to_phase(view_.plan(), detector, present())
                                                   : extends_phase(view_.plan(), detector, present());
            return is_own && extends_green(detector);
        });
    }

    // Returns true if a platoon that has been announced, or else a vehicle at a detector, extends the green.
    bool extends_green(const SignalDetector& detector) const {
        if (detector.platoon_rear_tick >= 0) {
            return !detector.platoon_can_wait || detector.platoon_rear_tick <= latest_end();
        }
        const bool is_used =
            is_at(view_.plan(), detector, kStopDetector) || is_at(view_.plan(), detector, kAdvanceDetector);
        return is_used && detector.last_occupied_tick >= 0 &&
               view_.tick() - detector.last_occupied_tick < phase(present()).gap_ticks;
    }

    // Returns the tick at which the maximum of the present green is over.
    std::int64_t latest_end() const {
        const SignalPhase& own = phase(present());
        return memory_[kMaximumFrom] + std::max(own.max_green_ticks, own.min_green_ticks);
    }

    std::int64_t begin_yellow(int next) {
        memory_[kNextPhase] = next;
        begin_interval(Interval::yellow);
        show_yellow(view_, present(), next, [this](int group) { green_end(group) = view_.tick(); });
        if (knows_protection()) end_other_protection(next);
        const std::int64_t ticks = phase(present()).yellow_ticks;
        return ticks > 0 ? view_.tick() + ticks : begin_all_red();
    }

    // Shows yellow for the green groups that only one of the present and the next phase protects.
    void end_other_protection(int next) {
        const std::uint64_t changing = protected_groups(present()) ^ protected_groups(next);
        for (int group = 0; group < view_.groups(); ++group) {
            if ((changing >> group & 1U) == 0 || view_.light(group) != Light::green) continue;
            view_.show(group, Light::yellow);
            green_end(group) = view_.tick();
        }
    }

    std::int64_t begin_all_red() {
        begin_interval(Interval::all_red);
        show_red_after_yellow(view_);
        const std::int64_t ticks = phase(present()).all_red_ticks;
        return ticks > 0 ? view_.tick() + ticks : begin_green(static_cast<int>(memory_[kNextPhase]));
    }

    // Returns the first phase of a run: the first one with a call, or else the first phase of the programme.
    int first_phase() const {
        const PhaseProgramme& programme = programme_now();
        const int called = called_in(programme, programme.first_phase, programme.last_phase());
        return called >= 0 ? called : programme.first_phase;
    }

    // Returns the next phase with a call, in the order of the cycle; -1: none. A new cycle uses the programme that is
    // in force now.
    int called_phase() const {
        const PhaseProgramme& own = programme_of(present());
        const int later = called_in(own, present() + 1, own.last_phase());
        if (later >= 0) return later;
        const PhaseProgramme& next = programme_now();
        const bool is_same = next.first_phase == own.first_phase;
        return called_in(next, next.first_phase, is_same ? present() - 1 : next.last_phase());
    }

    int called_in(const PhaseProgramme& programme, int first, int last) const {
        for (int number = first; number <= last; ++number) {
            if (has_call(programme, number)) return number;
        }
        return -1;
    }

    const PhaseProgramme& programme_now() const {
        return plan_.programmes[static_cast<std::size_t>(plan_.programme_at(view_.tick()))];
    }
    const PhaseProgramme& programme_of(int number) const {
        std::size_t k = 0;
        while (plan_.programmes[k].last_phase() < number) ++k;
        return plan_.programmes[k];
    }

    bool has_call(const PhaseProgramme& programme, int number) const {
        const SignalPhase& called = phase(number);
        if (called.recall != Recall::off) return true;
        const auto calls = [&](const SignalDetector& detector) {
            if ((detector.groups & called.green_groups) == 0 || !is_waiting(detector, called)) return false;
            if (knows_protection()) return belongs_to_phase(view_.plan(), detector, number);
            return serves_all(called, detector) || !has_full_service(programme, detector);
        };
        const auto detectors = view_.detectors();
        return std::any_of(detectors.begin(), detectors.end(), calls);
    }

    static bool serves_all(const SignalPhase& phase, const SignalDetector& detector) {
        return (detector.groups & ~phase.green_groups) == 0;
    }
    bool has_full_service(const PhaseProgramme& programme, const SignalDetector& detector) const {
        for (int number = programme.first_phase; number <= programme.last_phase(); ++number) {
            if (serves_all(phase(number), detector)) return true;
        }
        return false;
    }

    // Returns true if a vehicle on the detector's lane waits for a green that the phase would begin or protect.
    bool is_waiting(const SignalDetector& detector, const SignalPhase& called) const {
        std::uint64_t green_groups = 0;
        std::int64_t last_end = -1;
        for (int group = 0; group < view_.groups(); ++group) {
            if ((detector.groups >> group & 1U) == 0) continue;
            if (view_.light(group) == Light::green) green_groups |= std::uint64_t{1} << group;
            last_end = std::max(last_end, memory_[kGreenEnds + static_cast<std::size_t>(group)]);
        }
        if ((detector.groups & called.green_groups & ~green_groups) == 0 && !knows_protection()) return false;
        if (is_at(view_.plan(), detector, kStopDetector)) return detector.is_occupied;
        return is_at(view_.plan(), detector, kAdvanceDetector) && green_groups == 0 &&
               detector.last_crossing_tick > last_end;
    }

    SignalView& view_;
    const PhasePlan& plan_;
    std::span<std::int64_t> memory_;
};

std::int64_t start_actuated(SignalView& view) {
    ActuatedSignal signal(view);
    signal.reset();
    const std::int64_t first_tick = to_ticks(view.plan().settings.first_green_s, view.plan().step_s);
    return first_tick > view.tick() ? first_tick : signal.step();
}

NominalCycle actuated_cycle(const SignalSettings& settings, int /*groups*/) {
    if (settings.has_phases()) return phase_cycle(settings);
    return {settings.intersection_cycle_s(), settings.green_s};  // the settings are refused, see actuated_problems()
}

std::vector<SignalProblem> actuated_problems(const SignalSettings& settings, int /*groups*/) {
    if (!settings.has_phases()) return {{"controller", "'actuated' needs signal.phases or signal.programmes"}};
    std::vector<SignalProblem> problems;
    const auto add_problems = [&](const std::vector<PhaseSettings>& phases, const std::string& field) {
        for (std::size_t k = 0; k < phases.size(); ++k) {
            const bool has_movements =
                !phases[k].protected_movements.empty() || !phases[k].permissive_movements.empty();
            if (has_movements || phases[k].recall != "off") continue;
            problems.push_back({fmt::format("{}[{}].recall", field, k),
                                "a phase without movements has no detectors: it needs the recall minimum or maximum"});
        }
    };
    add_problems(settings.phases, "phases");
    for (std::size_t k = 0; k < settings.programmes.size(); ++k) {
        add_problems(settings.programmes[k].phases, fmt::format("programmes[{}].phases", k));
    }
    return problems;
}

}  // namespace

extern const SignalController kActuatedController{
    .name = "actuated",
    .meaning =
        "phases end at gaps in the traffic, between their minimum and maximum green, and are skipped without a call",
    .parameters = kActuatedParameters,
    .nominal_cycle = actuated_cycle,
    .init = start_actuated,
    .step = [](SignalView& view) { return ActuatedSignal(view).step(); },
    .next_green =
        [](const SignalView& view, int group, std::int64_t after_tick) {
            SignalView own = view;  // ActuatedSignal takes a view that it may change
            return ActuatedSignal(own).next_green(group, after_tick);
        },
    .memory_size = [](const SignalPlan& plan) { return kGreenEnds + plan.groups.size(); },
    .detectors_m = actuation_detectors_m,
    .platoon_range_m = [](const SignalPlan& plan) { return plan.values[kPlatoonRange]; },
    .problems = actuated_problems,
    .runs_phases = true};

}  // namespace stopline

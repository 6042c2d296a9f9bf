#include "signals/rings/ring_problems.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "signals/rings/ring_plan.h"

namespace stopline {

namespace {

constexpr double kRounding_s = 1e-6;

class RingChecker {
public:
    explicit RingChecker(const SignalSettings& settings) : settings_(settings), phases_(settings.phases) {}

    std::vector<SignalProblem> check() {
        if (phases_.empty()) {
            add("controller", "'dual_ring' needs signal.phases");
            return std::move(problems_);
        }
        for (std::size_t k = 0; k < phases_.size(); ++k) {
            if (!phases_[k].protected_movements.empty() || !phases_[k].permissive_movements.empty()) continue;
            add(fmt::format("phases[{}]", k), "a phase of a ring needs movements");
        }
        if (settings_.cycle_s > 0.0) {
            check_coordinated_phases();
            check_splits();
            if (problems_.empty()) check_minimums();
        } else {
            for (std::size_t k = 0; k < phases_.size(); ++k) {
                if (phases_[k].is_coordinated()) add(field(k, "coordinated"), "has no effect without signal.cycle");
            }
        }
        return std::move(problems_);
    }

private:
    static std::string field(std::size_t phase, const char* name) { return fmt::format("phases[{}].{}", phase, name); }
    void add(std::string name, std::string message) { problems_.push_back({std::move(name), std::move(message)}); }

    // Each ring needs one coordinated phase, and all of them lie on one side of the barriers.
    void check_coordinated_phases() {
        std::array<int, 3> phases_of_ring{};
        std::array<int, 3> coordinated_of_ring{};
        int barrier = 0;
        for (std::size_t k = 0; k < phases_.size(); ++k) {
            const auto ring = static_cast<std::size_t>(phases_[k].ring);
            ++phases_of_ring[ring];
            if (!phases_[k].is_coordinated()) continue;
            if (++coordinated_of_ring[ring] > 1)
                add(field(k, "coordinated"), fmt::format("ring {} already has a coordinated phase", ring));
            if (barrier == 0) barrier = phases_[k].barrier;
            if (phases_[k].barrier != barrier)
                add(field(k, "coordinated"), "the coordinated phases of both rings need the same barrier");
        }
        for (std::size_t ring = 1; ring < phases_of_ring.size(); ++ring) {
            if (phases_of_ring[ring] > 0 && coordinated_of_ring[ring] == 0)
                add("cycle", fmt::format("coordination needs a phase with 'coordinated: on' in ring {}", ring));
        }
    }

    // Both rings must take the same time on each side, and the cycle in total.
    void check_splits() {
        std::map<int, std::array<double, 3>> splits_s;  // [barrier][ring]
        for (const PhaseSettings& phase : phases_) {
            splits_s[phase.barrier][static_cast<std::size_t>(phase.ring)] += phase.total_s();
        }
        double sum_s = 0.0;
        for (const auto& [barrier, ring_s] : splits_s) {
            sum_s += std::max(ring_s[1], ring_s[2]);
            if (ring_s[1] == 0.0 || ring_s[2] == 0.0 || std::abs(ring_s[1] - ring_s[2]) < kRounding_s) continue;
            add("phases",
                fmt::format(
                    "with coordination both rings need the same time between barriers: the phases with barrier {} "
                    "take {:g} s in ring 1 and {:g} s in ring 2 (green, yellow and all_red)",
                    barrier, ring_s[1], ring_s[2]));
        }
        if (std::abs(sum_s - settings_.cycle_s) < kRounding_s) return;
        add("cycle", fmt::format("{:g} s is not the sum of the phases of a ring, {:g} s (green, yellow and all_red)",
                                 settings_.cycle_s, sum_s));
    }

    // The minimum green must fit in between start and force-off point.
    void check_minimums() {
        constexpr double kTick_s = 1e-3;
        const RingPlan plan = make_ring_plan(settings_, {}, kTick_s);
        for (std::size_t k = 0; k < phases_.size(); ++k) {
            const double longest_s =
                static_cast<double>(plan.phases[k].force_off - plan.phases[k].start_point) * kTick_s;
            if (phases_[k].min_green_s <= longest_s + kRounding_s) continue;
            add(field(k, "min_green"),
                fmt::format(
                    "{:g} s is longer than the green of the phase in coordination, {:g} s (the last phases before "
                    "a barrier end together)",
                    phases_[k].min_green_s, longest_s));
        }
    }

    const SignalSettings& settings_;
    const std::vector<PhaseSettings>& phases_;
    std::vector<SignalProblem> problems_;
};

}  // namespace

std::vector<SignalProblem> ring_problems(const SignalSettings& settings, int /*groups*/) {
    return RingChecker(settings).check();
}

}  // namespace stopline

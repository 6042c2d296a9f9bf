#include "sim/sharing.h"

#include <algorithm>

namespace stopline {

namespace {

constexpr int kSteps = 16;         // of each way in a trial
constexpr double kHopeless = 3.0;  // times as long as alone: after as many steps as it takes to be sure
constexpr int kSure = 3;
constexpr double kRest = 100.0;         // times what a trial took, until the next
constexpr double kShortest_ns = 0.2e9;  // at least

}  // namespace

void Sharing::made(std::chrono::nanoseconds took, int vehicles) {
    const auto ns = static_cast<double>(took.count());
    if (!trying_) {
        rest_ns_ -= ns;
        if (rest_ns_ > 0.0) return;
        trying_ = true;
        shares_ = false;
        alone_ = shared_ = {};
        return;
    }
    Trial& trial = shares_ ? shared_ : alone_;
    ++trial.steps;
    trial.ns += ns;
    trial.vehicles += std::max(vehicles, 1);
    if (!shares_) {
        shares_ = trial.steps == kSteps;
        return;
    }
    const bool hopeless = trial.steps >= kSure && trial.ns_a_vehicle() > kHopeless * alone_.ns_a_vehicle();
    if (trial.steps == kSteps || hopeless) decide();
}

void Sharing::decide() {
    shares_ = shared_.ns_a_vehicle() < alone_.ns_a_vehicle();
    trying_ = false;
    rest_ns_ = std::max(kRest * (alone_.ns + shared_.ns), kShortest_ns);
}

}  // namespace stopline

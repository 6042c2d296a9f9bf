#include "runs/run_kind.h"

#include <array>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "base/defined_elsewhere.h"
#include "base/input_error.h"
#include "scenario/kinds/network_kind.h"

namespace stopline {

static std::span<const RunKind* const> run_kinds() {
    static const std::array kKinds{
        // NOLINTBEGIN(readability-identifier-naming): the macro declares constants of the namespace inside a function.
        STOPLINE_DEFINED_ELSEWHERE(RunKind, kSingleLightRun), STOPLINE_DEFINED_ELSEWHERE(RunKind, kIntersectionRun),
        STOPLINE_DEFINED_ELSEWHERE(RunKind, kNetworkRun),
        // NOLINTEND(readability-identifier-naming)
    };
    return kKinds;
}

const RunKind& run_kind(const Scenario& scenario) {
    const std::string_view name = network_kind(scenario.network).run;
    for (const RunKind* kind : run_kinds()) {
        if (name == kind->name) return *kind;
    }
    throw InputError(fmt::format("networks of the kind '{}' cannot be run: there is no way of running '{}'",
                                 scenario.network.kind, name));
}

}  // namespace stopline

#include "runs/run_kind.h"

#include <array>
#include <string_view>

#include <fmt/format.h>

#include "base/input_error.h"
#include "scenario/kinds/network_kind.h"

namespace stopline {

extern const RunKind kSingleLightRun;
extern const RunKind kIntersectionRun;
extern const RunKind kNetworkRun;

const RunKind& run_kind(const Scenario& scenario) {
    const std::string_view name = network_kind(scenario.network).run;
    for (const RunKind* kind : {&kSingleLightRun, &kIntersectionRun, &kNetworkRun}) {
        if (name == kind->name) return *kind;
    }
    throw InputError(fmt::format("networks of the kind '{}' cannot be run: there is no way of running '{}'",
                                 scenario.network.kind, name));
}

}  // namespace stopline

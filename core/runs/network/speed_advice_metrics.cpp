#include "runs/network/speed_advice_metrics.h"

#include "base/units.h"
#include "scenario/fleets.h"

namespace stopline {

MetricList<MeasuredNetwork> speed_advice_metrics() {
    return {
        {.column = "speed_advice_h",
         .unit = "veh h",
         .extent = "run",
         .meaning = "time for which vehicles follow the speed advice of signals (`driver.speed_advice`), without their "
                    "followers",
         .value = [](const MeasuredNetwork& run) { return run.result.delays.advised_s / kSecondsPerHour; },
         .summary_decimals = 3,
         .asked_for =
             [](const Scenario& scenario) {
                 return any_driver(scenario, [](const DriverSettings& driver) { return driver.speed_advice.is_on(); });
             }}};
}

}  // namespace stopline

#include "sim/state/queries/response_time.h"

#include <algorithm>

namespace stopline {

double response_time_s(const Model& model, int policy) {
    constexpr double kEstimate_s = 0.05;  // twice the time constant of the LeaderFilter
    constexpr double kReserve_s = 0.06;
    const V2vPlan& plan = model.v2v_plan;
    const double brake_lag_s = model.vehicle_of(policy).brake_lag_s;
    const double by_radar_s = model.driver_of(policy).tables.cacc.radar_delay_s + kEstimate_s + brake_lag_s;
    if (!plan.is_lossless) return by_radar_s;
    double shortest_lag_s = brake_lag_s;
    for (const PowertrainTables& type : model.vehicles) shortest_lag_s = std::min(shortest_lag_s, type.brake_lag_s);
    return std::min(by_radar_s, plan.longest_notice_s + kReserve_s + brake_lag_s - shortest_lag_s);
}

}  // namespace stopline

#include "sim/vehicle_arrays.h"

#include <algorithm>

namespace stopline {

template <class Visit>
void VehicleArrays::for_each_array(Visit visit) {
    visit(position_m), visit(speed_mps), visit(acceleration_mps2), visit(request_mps2), visit(torque_Nm);
    visit(brake_N), visit(gear_time_s), visit(lag_s), visit(length_m), visit(gear), visit(leads);
    visit(standstill_gap_m), visit(end_speed_mps), visit(policy), visit(type), visit(id), visit(predecessor);
    visit(route), visit(route_index), visit(cleared_for), visit(inside_since), visit(held_at);
    visit(next_lane), visit(came_from), visit(stands_since);
}

void VehicleArrays::resize(int slot_count, int radar_row_count, int v2v_row_count) {
    slots = slot_count;
    radar_rows = radar_row_count;
    v2v_rows = v2v_row_count;
    const auto n = static_cast<std::size_t>(slot_count);
    for_each_array([n](auto& array) { array.assign(n, {}); });
    // Free slots are computed too: their divisors must not be zero.
    lag_s.assign(n, 1.0F);
    for (auto* rows : {&radar_gap_m, &radar_closing_mps}) rows->assign(n * static_cast<std::size_t>(radar_rows), 0.0F);
    for (auto* rows : {&v2v_acceleration_mps2, &v2v_request_mps2, &v2v_rate_1ps}) {
        rows->assign(n * static_cast<std::size_t>(v2v_rows), 1.0F);
    }
}

void VehicleArrays::copy(int from, int to) {
    const auto source = static_cast<std::size_t>(from);
    const auto target = static_cast<std::size_t>(to);
    for_each_array([source, target](auto& array) { array[target] = array[source]; });
    for (int r = 0; r < radar_rows; ++r) {
        radar_gap_m[row(r, to)] = radar_gap_m[row(r, from)];
        radar_closing_mps[row(r, to)] = radar_closing_mps[row(r, from)];
    }
    for (int r = 0; r < v2v_rows; ++r) {
        v2v_acceleration_mps2[row(r, to)] = v2v_acceleration_mps2[row(r, from)];
        v2v_request_mps2[row(r, to)] = v2v_request_mps2[row(r, from)];
        v2v_rate_1ps[row(r, to)] = v2v_rate_1ps[row(r, from)];
    }
}

void VehicleArrays::move(int from, int count, int to) {
    const auto moved = [&](auto& array, int row_index) {
        const auto first = array.begin() + static_cast<std::ptrdiff_t>(row(row_index, from));
        std::copy(first, first + count, array.begin() + static_cast<std::ptrdiff_t>(row(row_index, to)));
    };
    for_each_array([&](auto& array) { moved(array, 0); });
    for (int r = 0; r < radar_rows; ++r) moved(radar_gap_m, r), moved(radar_closing_mps, r);
    for (int r = 0; r < v2v_rows; ++r) {
        moved(v2v_acceleration_mps2, r), moved(v2v_request_mps2, r), moved(v2v_rate_1ps, r);
    }
}

void VehicleArrays::reset_radar(int slot, double gap_m, double closing_mps) {
    for (int r = 0; r < radar_rows; ++r) {
        radar_gap_m[row(r, slot)] = static_cast<float>(gap_m);
        radar_closing_mps[row(r, slot)] = static_cast<float>(closing_mps);
    }
}

void VehicleArrays::reset_v2v(int slot) {
    const auto i = static_cast<std::size_t>(slot);
    for (int r = 0; r < v2v_rows; ++r) {
        v2v_acceleration_mps2[row(r, slot)] = acceleration_mps2[i];
        v2v_request_mps2[row(r, slot)] = request_mps2[i];
        v2v_rate_1ps[row(r, slot)] = 1.0F / lag_s[i];
    }
}

}  // namespace stopline

#include "sim/state/vehicles/vehicle_arrays.h"

#include <algorithm>

#include "sim/state/state.h"

namespace stopline {

template <class Visit>
void VehicleArrays::for_each_common(Visit visit) {
    visit(position_m), visit(speed_mps), visit(acceleration_mps2), visit(length_m), visit(end_speed_mps),
        visit(is_platoon_leader);
    visit(policy), visit(id), visit(next_lane), visit(record), visit(stopped_since_tick), visit(standstill_gap_m);
    if (has_several_types) visit(type);
    if (has_itineraries) visit(itinerary);
    if (has_lane_changes) visit(lane_memory);
    if (has_human_drivers) visit(start_ticks);
    if (has_v2v_channel) v2v.for_each(visit);
    if (has_platoon_limit) platoon.for_each(visit);
}

template <class Visit>
void VehicleArrays::for_each_powertrain(Visit visit) {
    visit(request_mps2), visit(torque_Nm), visit(brake_N), visit(gear_time_s), visit(lag_s), visit(gear);
}

template <class Visit>
void VehicleArrays::for_each_of_lane(Visit visit) {
    visit(limit_mps), visit(next_limit_m), visit(speed_cap_mps);
}

void VehicleArrays::resize(int slot_count, int radar_row_count, int v2v_row_count) {
    slots = slot_count;
    radar_rows = radar_row_count;
    v2v_rows = v2v_row_count;
    const auto n = static_cast<std::size_t>(slot_count);
    for_each_common([n](auto& array) { array.assign(n, {}); });
    for_each_powertrain([n](auto& array) { array.assign(n, {}); });
    if (has_v2v_channel) v2v.sent.assign(n * static_cast<std::size_t>(v2v.stored_messages), {});
    for (int slot = 0; slot < slot_count && has_v2v_channel; ++slot) v2v.reset(slot);
    // The kernels do their computations for free slots, too, and divide by the lag. The lag of a free slot must
    // therefore not be 0.
    lag_s.assign(n, 1.0F);
    for (auto* rows : {&radar_gap_m, &radar_closing_mps}) rows->assign(n * static_cast<std::size_t>(radar_rows), 0.0F);
    if (stores_own_speed()) own_speed_mps.assign(n * static_cast<std::size_t>(radar_rows), 0.0F);
    for (auto* rows : {&v2v_acceleration_mps2, &v2v_request_mps2, &v2v_rate_1ps}) {
        rows->assign(n * static_cast<std::size_t>(v2v_rows), 1.0F);
    }
}

void VehicleArrays::reserve(int slot_count) {
    const auto reserved = [slot_count](auto& array) { array.reserve(static_cast<std::size_t>(slot_count)); };
    for_each_common(reserved);
    for_each_of_lane(reserved);
}

void VehicleArrays::grow(int slot_count) {
    slots = slot_count;
    id.resize(static_cast<std::size_t>(slot_count), -1);
    speed_cap_mps.resize(static_cast<std::size_t>(slot_count), kUnlimitedSpeed_mps);
    end_speed_mps.resize(static_cast<std::size_t>(slot_count), kNoLowerLimit_mps);
    const auto resized = [slot_count](auto& array) { array.resize(static_cast<std::size_t>(slot_count)); };
    for_each_common(resized);
    for_each_of_lane(resized);
}

void VehicleArrays::copy(int from, int to) {
    const auto source = static_cast<std::size_t>(from);
    const auto target = static_cast<std::size_t>(to);
    const auto copied = [source, target](auto& array) { array[target] = array[source]; };
    for_each_common(copied);
    if (!has_powertrain()) return;
    for_each_powertrain(copied);
    for (int k = 0; k < v2v.stored_messages && has_v2v_channel; ++k) {
        v2v.sent[v2v.index_of(to, k)] = v2v.sent[v2v.index_of(from, k)];
    }
    for (int r = 0; r < radar_rows; ++r) {
        radar_gap_m[row(r, to)] = radar_gap_m[row(r, from)];
        radar_closing_mps[row(r, to)] = radar_closing_mps[row(r, from)];
        if (stores_own_speed()) own_speed_mps[row(r, to)] = own_speed_mps[row(r, from)];
    }
    for (int r = 0; r < v2v_rows; ++r) {
        v2v_acceleration_mps2[row(r, to)] = v2v_acceleration_mps2[row(r, from)];
        v2v_request_mps2[row(r, to)] = v2v_request_mps2[row(r, from)];
        v2v_rate_1ps[row(r, to)] = v2v_rate_1ps[row(r, from)];
    }
}

void VehicleArrays::move(int from, int count, int to) {
    if (count == 0 || from == to) return;
    const auto moved_numbers = [&](auto& array, std::size_t from_index, std::size_t to_index, int numbers) {
        const auto first = array.begin() + static_cast<std::ptrdiff_t>(from_index);
        const auto target = array.begin() + static_cast<std::ptrdiff_t>(to_index);
        if (to < from) {
            std::copy(first, first + numbers, target);
        } else {
            std::copy_backward(first, first + numbers, target + numbers);
        }
    };
    const auto moved = [&](auto& array, int row_index) {
        moved_numbers(array, row(row_index, from), row(row_index, to), count);
    };
    for_each_common([&](auto& array) { moved(array, 0); });
    if (!has_powertrain()) {
        for_each_of_lane([&](auto& array) { moved(array, 0); });
        const auto vacated = [&](int slot) { return slot < to || slot >= to + count; };
        for (int slot = from; slot < from + count; ++slot) {
            if (vacated(slot)) clear_slot(slot);
        }
        return;
    }
    for_each_powertrain([&](auto& array) { moved(array, 0); });
    if (has_v2v_channel) {
        moved_numbers(v2v.sent, v2v.index_of(from, 0), v2v.index_of(to, 0), count * v2v.stored_messages);
    }
    for (int r = 0; r < radar_rows; ++r) moved(radar_gap_m, r), moved(radar_closing_mps, r);
    for (int r = 0; r < radar_rows && stores_own_speed(); ++r) moved(own_speed_mps, r);
    for (int r = 0; r < v2v_rows; ++r) {
        moved(v2v_acceleration_mps2, r), moved(v2v_request_mps2, r), moved(v2v_rate_1ps, r);
    }
}

void VehicleArrays::reset_radar(int slot, double gap_m, double closing_mps) {
    for (int r = 0; r < radar_rows; ++r) {
        radar_gap_m[row(r, slot)] = static_cast<float>(gap_m);
        radar_closing_mps[row(r, slot)] = static_cast<float>(closing_mps);
    }
    if (!stores_own_speed()) return;
    const auto own_mps = static_cast<float>(speed_mps[static_cast<std::size_t>(slot)]);
    for (int r = 0; r < radar_rows; ++r) own_speed_mps[row(r, slot)] = own_mps;
}

void VehicleArrays::reset_powertrain(int slot, const PowertrainTables& vehicle, double speed) {
    if (!has_powertrain()) return;
    const auto i = static_cast<std::size_t>(slot);
    request_mps2[i] = torque_Nm[i] = brake_N[i] = 0.0F;
    gear_time_s[i] = static_cast<float>(vehicle.minimum_gear_time_s);
    lag_s[i] = static_cast<float>(vehicle.lag_unloaded_s[0]);
    gear[i] = static_cast<float>(cruising_gear(vehicle, speed));
}

void VehicleArrays::reset_v2v(int slot) {
    if (!has_powertrain()) return;
    const auto i = static_cast<std::size_t>(slot);
    for (int r = 0; r < v2v_rows; ++r) {
        v2v_acceleration_mps2[row(r, slot)] = acceleration_mps2[i];
        v2v_request_mps2[row(r, slot)] = request_mps2[i];
        v2v_rate_1ps[row(r, slot)] = 1.0F / lag_s[i];
    }
    const auto speed = static_cast<float>(speed_mps[i]);
    for (int k = 0; k < v2v.stored_messages && has_v2v_channel; ++k) {
        v2v.sent[v2v.index_of(slot, k)] = {acceleration_mps2[i], request_mps2[i], 1.0F / lag_s[i], speed};
    }
}

}  // namespace stopline

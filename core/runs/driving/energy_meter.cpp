#include "runs/driving/energy_meter.h"

#include <algorithm>
#include <cmath>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "base/units.h"
#include "scenario/fleets.h"

namespace stopline {

namespace {

constexpr double kGramsPerKg = 1000.0;
constexpr double kLitresPerM3 = 1000.0;

// Returns the whole number of seconds that divides a run into 200 intervals at most.
double series_interval_s(const Scenario& scenario) {
    constexpr double kIntervals = 200.0;
    return std::max(1.0, std::ceil(scenario.end_s() / kIntervals));
}

// Returns the energy settings of each policy of the model. With vehicle types of SUMO, each component has as many
// policies as there are types. The types change the length of the vehicle only.
std::vector<EnergySettings> settings_by_policy(const Scenario& scenario, const PopulationSettings& population,
                                               const Model& model) {
    const std::size_t per_component = model.policies.size() / population.components.size();
    std::vector<EnergySettings> settings;
    for (std::size_t policy = 0; policy < model.policies.size(); ++policy) {
        settings.push_back(vehicle_of(scenario, population.components[policy / per_component]).energy.value());
    }
    return settings;
}

}  // namespace

EnergyTotals energy_totals(const std::vector<VehicleEnergy>& vehicles, const std::optional<TimeWindow>& window) {
    EnergyTotals totals;
    for (const VehicleEnergy& vehicle : vehicles) {
        if (window && !window->contains(vehicle.left_s)) continue;
        EnergySums& sums = vehicle.has_battery ? totals.battery : totals.fuel;
        ++sums.vehicles;
        sums.distance_km += vehicle.work.distance_m / 1000.0;
        sums.amount += vehicle.has_battery ? vehicle.use.battery_J / kSecondsPerHour : vehicle.use.fuel_g;
        sums.stops += vehicle.stops;
        totals.fuel_l += vehicle.fuel_l;
        totals.co2_g += vehicle.co2_g;
        ++totals.vehicles;
        totals.stops += vehicle.stops;
        totals.idle_s += vehicle.idle_s;
    }
    return totals;
}

EnergyMeter::EnergyMeter(const Scenario& scenario, std::size_t population, const Model& model)
    : model_(model),
      settings_(settings_by_policy(scenario, scenario.populations.at(population), model)),
      interval_ticks_(to_ticks(series_interval_s(scenario), model.step_s)) {
    EngineLoad at_rest;
    at_rest.is_at_rest = true;
    for (std::size_t policy = 0; policy < model.policies.size(); ++policy) {
        policy_names_.push_back(model.policies[policy].settings.name);
        const PowertrainTables& vehicle = model.vehicle_of(static_cast<int>(policy));
        rest_use_.push_back(energy_use(settings_[policy], vehicle, at_rest, model.step_s));
    }
}

void EnergyMeter::observe(const State& state) {
    tick_ = state.tick;
    const auto interval = static_cast<std::size_t>(std::max<std::int64_t>(tick_ - 1, 0) / interval_ticks_);
    if (fuel_g_.size() <= interval) {
        fuel_g_.resize(interval + 1, 0.0);
        battery_J_.resize(interval + 1, 0.0);
    }
    if (const std::size_t ids = at(state.insertion.next_id); tracks_.size() < ids) {
        if (tracks_.capacity() < ids) tracks_.reserve(2 * ids);
        tracks_.resize(ids);
    }
    for (int lane = 0; lane < static_cast<int>(state.blocks.size()); ++lane) {
        const LaneBlock& block = state.blocks[at(lane)];
        for (int slot = block.first; slot < block.past_last(); ++slot) observe(state, lane, at(slot));
    }
}

void EnergyMeter::observe(const State& state, int lane, std::size_t slot) {
    const VehicleArrays& v = state.vehicles;
    Track& track = tracks_[at(v.id[slot])];
    PowertrainReading now{v.speed_mps[slot]};
    if (v.has_powertrain()) {
        now.torque_Nm = static_cast<double>(v.torque_Nm[slot]);
        now.brake_N = static_cast<double>(v.brake_N[slot]);
        now.gear_time_s = static_cast<double>(v.gear_time_s[slot]);
        now.gear = static_cast<int>(v.gear[slot]);
    }
    if (track.last_tick < 0) {
        track.entered_tick = tick_;
        track.sums.id = v.id[slot];
        track.sums.policy = v.policy[slot];
        track.sums.has_battery = settings_[at(v.policy[slot])].source == "battery";
    }
    // A vehicle that is new, or was teleported, begins a new sequence of steps.
    if (track.last_tick >= 0 && track.last_tick == tick_ - 1) {
        add_step(track, now);
    } else {
        track.reading = model_.meso ? estimated_start(model_.vehicle_of(v.policy[slot]), now.speed_mps) : now;
    }
    if (now.speed_mps < kStoppedSpeed_mps && track.may_stop) {
        ++track.sums.stops;
        track.may_stop = false;
    }
    if (now.speed_mps > kQueuedSpeed_mps) track.may_stop = true;
    track.sine = static_cast<double>(state.plan.lane(lane).sine);
    track.last_tick = tick_;
}

void EnergyMeter::add_step(Track& track, const PowertrainReading& now) {
    VehicleEnergy& sums = track.sums;
    if (now.speed_mps <= 0.0 && track.reading.speed_mps <= 0.0) return add_step_at_rest(track, now);
    const PowertrainTables& vehicle = model_.vehicle_of(sums.policy);
    const EnergySettings& settings = settings_[at(sums.policy)];
    const double dt = model_.step_s;
    FinishedStep step;
    if (model_.meso) {
        step = estimated_step(vehicle, now.speed_mps, track.sine, dt, track.reading);
    } else {
        step = finished_step(vehicle, track.reading, now, track.sine, dt);
        track.reading = now;
    }
    const EnergyUse use = energy_use(settings, vehicle, step.engine, dt);
    sums.use += use;
    sums.work += step.work;
    if (now.speed_mps < kStoppedSpeed_mps) sums.idle_s += dt;
    fuel_g_.back() += use.fuel_g;
    battery_J_.back() += use.battery_J;
}

void EnergyMeter::add_step_at_rest(Track& track, const PowertrainReading& now) {
    const EnergyUse& use = rest_use_[at(track.sums.policy)];
    track.sums.use += use;
    track.sums.idle_s += model_.step_s;
    fuel_g_.back() += use.fuel_g;
    battery_J_.back() += use.battery_J;
    if (model_.meso) {
        track.reading.gear_time_s += model_.step_s;
    } else {
        track.reading = now;
    }
}

EnergyResult EnergyMeter::finish(const State& state, const std::optional<TimeWindow>& window) const {
    EnergyResult result;
    result.exists = true;
    result.is_estimate = model_.meso;
    result.policy_names = policy_names_;
    const LaneBlock& teleporting = state.congestion.teleporting;
    std::vector<bool> is_teleporting(tracks_.size(), false);
    for (int slot = teleporting.first; slot < teleporting.past_last(); ++slot) {
        is_teleporting[at(state.vehicles.id[at(slot)])] = true;
    }
    for (std::size_t id = 0; id < tracks_.size(); ++id) {
        const Track& track = tracks_[id];
        if (track.last_tick < 0) continue;
        result.work += track.sums.work;
        VehicleEnergy vehicle = track.sums;
        const EnergySettings& settings = settings_[at(vehicle.policy)];
        vehicle.entered_s = model_.time_s(track.entered_tick);
        if (track.last_tick < tick_ && !is_teleporting[id]) vehicle.left_s = model_.time_s(track.last_tick + 1);
        if (!vehicle.has_battery) {
            vehicle.fuel_l = vehicle.use.fuel_g / kGramsPerKg / settings.fuel_density_kg_per_m3 * kLitresPerM3;
            vehicle.co2_g = vehicle.use.fuel_g * settings.co2_per_fuel;
        }
        result.vehicles.push_back(vehicle);
    }
    result.totals = energy_totals(result.vehicles, window);
    result.interval_s = model_.time_s(interval_ticks_);
    // The last interval may be incomplete.
    for (std::size_t k = 0; k < fuel_g_.size(); ++k) {
        const double from_s = static_cast<double>(k) * result.interval_s;
        const double length_s = std::min(result.interval_s, model_.time_s(tick_) - from_s);
        result.fuel_g_per_s.push_back(length_s > 0.0 ? fuel_g_[k] / length_s : 0.0);
        result.battery_W.push_back(length_s > 0.0 ? battery_J_[k] / length_s : 0.0);
    }
    return result;
}

}  // namespace stopline

#include <algorithm>
#include <unordered_map>

#include "base/io/escape.h"
#include "base/speed_thresholds.h"
#include "record/departure_delay.h"
#include "record/lane_names.h"
#include "record/sumo_files.h"
#include "record/xml_file.h"
#include "sim/state/queries/vehicle_names.h"

namespace stopline {

namespace {

struct Trip {
    double depart_s = 0.0;  // first time at which the vehicle is in the network
    double departure_delay_s = 0.0;
    double depart_m = 0.0;
    double depart_mps = 0.0;
    std::string depart_lane;
    int policy = 0;
    int number = -1;  // index in DemandPlan::trips; -1: the vehicle has no planned trip
    // State of the vehicle in the latest step:
    int lane = -1;
    double position_m = 0.0;
    double speed_mps = 0.0;
    std::int64_t last_tick = -1;
    bool is_stopped = false;
    // Totals of the trip so far:
    double distance_m = 0.0;
    double stopped_s = 0.0;
    double time_loss_s = 0.0;
    int stops = 0;
};

class TripinfoWriter : public RunWriter {
public:
    TripinfoWriter(const std::filesystem::path& file, const Model& model)
        : model_(model),
          xml_(file, "tripinfos", "tripinfo_file.xsd"),
          lane_names_(model.graph, LaneNames::Style::sumo) {}

    void observe(const State& state) override {
        for (int lane = 0; lane < static_cast<int>(state.blocks.size()); ++lane) {
            const LaneBlock& block = state.blocks[static_cast<std::size_t>(lane)];
            for (int slot = block.first; slot < block.past_last(); ++slot)
                update_trip(state, lane, static_cast<std::size_t>(slot));
        }
        for (int slot = state.congestion.teleporting.first; slot < state.congestion.teleporting.past_last(); ++slot) {
            const auto trip = trips_.find(state.vehicles.id[static_cast<std::size_t>(slot)]);
            if (trip != trips_.end()) trip->second.last_tick = state.tick;
        }
        if (static_cast<std::int64_t>(trips_.size()) > state.present()) write_ended_trips(state.tick);
    }

    std::string finish() override {
        xml_.finish();
        return fmt::format("{} trips; {} vehicles are still on their way", ended_, trips_.size());
    }

private:
    void update_trip(const State& state, int lane, std::size_t slot) {
        const VehicleArrays& v = state.vehicles;
        Trip& trip = trips_[v.id[slot]];
        const double speed_mps = v.speed_mps[slot];
        if (trip.last_tick < 0) {
            trip.depart_s = model_.time_s(state.tick);
            const LaneNames::Place place = lane_names_.front(state, lane, slot);
            trip.depart_m = place.position_m;
            trip.depart_mps = speed_mps;
            trip.depart_lane = place.lane;
            trip.policy = v.policy[slot];
            trip.number = v.itinerary_of(slot).trip;
            trip.departure_delay_s = departure_delay_s(model_, trip.number, state.tick);
        } else {
            const double limit_mps = model_.graph.lanes[static_cast<std::size_t>(lane)].limit_mps;
            const bool is_stopped = speed_mps < kStoppedSpeed_mps;
            trip.distance_m += speed_mps * model_.step_s;
            trip.time_loss_s += std::max(1.0 - speed_mps / limit_mps, 0.0) * model_.step_s;
            trip.stopped_s += is_stopped ? model_.step_s : 0.0;
            trip.stops += is_stopped && !trip.is_stopped ? 1 : 0;
            trip.is_stopped = is_stopped;
        }
        trip.lane = lane;
        trip.position_m = v.position_m[slot];
        trip.speed_mps = speed_mps;
        trip.last_tick = state.tick;
    }

    // Writes all trips that have ended and removes them from the map. The rows are sorted by vehicle, so the order in
    // the file does not depend on the hash map.
    void write_ended_trips(std::int64_t tick) {
        std::vector<int> exited;
        for (const auto& [vehicle, trip] : trips_) {
            if (trip.last_tick < tick) exited.push_back(vehicle);
        }
        std::sort(exited.begin(), exited.end());
        for (const int vehicle : exited) {
            write(vehicle, trips_.at(vehicle), tick);
            trips_.erase(vehicle);
        }
    }

    void write(int vehicle, const Trip& trip, std::int64_t tick) {
        const LaneNames::Place arrival = lane_names_.end(trip.lane);
        const double arrival_s = model_.time_s(tick);
        const double distance_m = trip.distance_m + std::max(lane_names_.to_end_m(trip.lane, trip.position_m), 0.0);
        xml_.add(
            "    <tripinfo id=\"{}\" depart=\"{:.2f}\" departLane=\"{}\" departPos=\"{:.2f}\" departSpeed=\"{:.2f}\" "
            "departDelay=\"{:.2f}\" arrival=\"{:.2f}\" arrivalLane=\"{}\" arrivalPos=\"{:.2f}\" arrivalSpeed=\"{:.2f}\" ",
            escape_xml(vehicle_name(model_, trip.number, vehicle)), trip.depart_s, trip.depart_lane, trip.depart_m,
            trip.depart_mps, trip.departure_delay_s, arrival_s, arrival.lane, arrival.position_m, trip.speed_mps);
        xml_.add(
            "duration=\"{:.2f}\" routeLength=\"{:.2f}\" waitingTime=\"{:.2f}\" waitingCount=\"{}\" stopTime=\"0.00\" "
            "timeLoss=\"{:.2f}\" rerouteNo=\"0\" devices=\"\" vType=\"{}\" speedFactor=\"1.00\" vaporized=\"\"/>\n",
            arrival_s - trip.depart_s, distance_m, trip.stopped_s, trip.stops, trip.time_loss_s,
            escape_xml(model_.policies[static_cast<std::size_t>(trip.policy)].settings.name));
        ++ended_;
    }

    const Model& model_;
    XmlFile xml_;
    LaneNames lane_names_;
    std::unordered_map<int, Trip> trips_;  // [vehicle]
    std::int64_t ended_ = 0;
};

}  // namespace

std::unique_ptr<RunWriter> make_tripinfo_writer(const std::filesystem::path& file, const Model& model) {
    return std::make_unique<TripinfoWriter>(file, model);
}

}  // namespace stopline

#include <algorithm>
#include <unordered_map>

#include "record/sumo_files.h"
#include "record/vehicle_name.h"
#include "record/xml_file.h"

namespace stopline {

namespace {

constexpr double kWaits_mps = 0.1;  // SUMO's limit

struct Trip {
    double depart_s = 0.0;
    double depart_m = 0.0;
    double depart_mps = 0.0;
    int depart_lane = -1;
    int policy = 0;
    int number = -1;  // of the demand; -1: it drew its way
    // As seen last.
    int lane = -1;
    double position_m = 0.0;
    double speed_mps = 0.0;
    std::int64_t seen = -1;
    bool waits = false;
    // Sums.
    double driven_m = 0.0;
    double waited_s = 0.0;
    double lost_s = 0.0;
    int waits_begun = 0;
};

class TripinfoWriter : public RunWriter {
public:
    TripinfoWriter(const std::filesystem::path& file, const Model& model)
        : model_(model), xml_(file, "tripinfos", "tripinfo_file.xsd") {}

    void look(const State& state) override {
        for (int lane = 0; lane < static_cast<int>(state.blocks.size()); ++lane) {
            const LaneBlock& block = state.blocks[static_cast<std::size_t>(lane)];
            for (int slot = block.first; slot < block.stop(); ++slot) see(state, lane, static_cast<std::size_t>(slot));
        }
        for (int slot = state.limbo.first; slot < state.limbo.stop(); ++slot) {
            const auto trip = trips_.find(state.vehicles.id[static_cast<std::size_t>(slot)]);
            if (trip != trips_.end()) trip->second.seen = state.tick;
        }
        if (static_cast<std::int64_t>(trips_.size()) > state.present()) end_trips(state.tick);
    }

    std::string finish() override {
        xml_.finish();
        return fmt::format("{} trips; {} vehicles are still on theirs", ended_, trips_.size());
    }

private:
    void see(const State& state, int lane, std::size_t slot) {
        const VehicleArrays& v = state.vehicles;
        Trip& trip = trips_[v.id[slot]];
        const double speed_mps = v.speed_mps[slot];
        if (trip.seen < 0) {
            trip.depart_s = model_.time_s(state.tick);
            trip.depart_m = v.position_m[slot];
            trip.depart_mps = speed_mps;
            trip.depart_lane = lane;
            trip.policy = v.policy[slot];
            trip.number = v.record[slot].trip;
        } else {
            const double limit_mps = model_.graph.lanes[static_cast<std::size_t>(lane)].limit_mps;
            const bool waits = speed_mps < kWaits_mps;
            trip.driven_m += speed_mps * model_.step_s;
            trip.lost_s += std::max(1.0 - speed_mps / limit_mps, 0.0) * model_.step_s;
            trip.waited_s += waits ? model_.step_s : 0.0;
            trip.waits_begun += waits && !trip.waits ? 1 : 0;
            trip.waits = waits;
        }
        trip.lane = lane;
        trip.position_m = v.position_m[slot];
        trip.speed_mps = speed_mps;
        trip.seen = state.tick;
    }

    // By number, so that the file does not depend on the order of a hash.
    void end_trips(std::int64_t tick) {
        std::vector<int> gone;
        for (const auto& [vehicle, trip] : trips_) {
            if (trip.seen < tick) gone.push_back(vehicle);
        }
        std::sort(gone.begin(), gone.end());
        for (const int vehicle : gone) {
            write(vehicle, trips_.at(vehicle), tick);
            trips_.erase(vehicle);
        }
    }

    void write(int vehicle, const Trip& trip, std::int64_t tick) {
        const Lane& from = model_.graph.lanes[static_cast<std::size_t>(trip.depart_lane)];
        const Lane& to = model_.graph.lanes[static_cast<std::size_t>(trip.lane)];
        const double arrival_s = model_.time_s(tick);
        const double driven_m = trip.driven_m + std::max(to.length_m - trip.position_m, 0.0);
        xml_.add(
            "    <tripinfo id=\"{}\" depart=\"{:.2f}\" departLane=\"{}\" departPos=\"{:.2f}\" departSpeed=\"{:.2f}\" "
            "departDelay=\"{:.2f}\" arrival=\"{:.2f}\" arrivalLane=\"{}\" arrivalPos=\"{:.2f}\" arrivalSpeed=\"{:.2f}\" ",
            vehicle_name(model_, trip.number, vehicle), trip.depart_s, sumo_lane_name(from), trip.depart_m,
            trip.depart_mps, delay_s(trip), arrival_s, sumo_lane_name(to), to.length_m, trip.speed_mps);
        xml_.add(
            "duration=\"{:.2f}\" routeLength=\"{:.2f}\" waitingTime=\"{:.2f}\" waitingCount=\"{}\" stopTime=\"0.00\" "
            "timeLoss=\"{:.2f}\" rerouteNo=\"0\" devices=\"\" vType=\"{}\" speedFactor=\"1.00\" vaporized=\"\"/>\n",
            arrival_s - trip.depart_s, driven_m, trip.waited_s, trip.waits_begun, trip.lost_s,
            xml_escaped(model_.policies[static_cast<std::size_t>(trip.policy)].settings.name));
        ++ended_;
    }

    // Where nobody is known to wait outside there is none.
    double delay_s(const Trip& trip) const {
        if (trip.number < 0) return 0.0;
        return std::max(trip.depart_s - model_.demand.trips[static_cast<std::size_t>(trip.number)].depart_s, 0.0);
    }

    const Model& model_;
    XmlFile xml_;
    std::unordered_map<int, Trip> trips_;  // by vehicle
    std::int64_t ended_ = 0;
};

}  // namespace

std::unique_ptr<RunWriter> make_tripinfo_writer(const std::filesystem::path& file, const Model& model) {
    return std::make_unique<TripinfoWriter>(file, model);
}

}  // namespace stopline

#include <cmath>
#include <numbers>

#include "base/io/escape.h"
#include "record/lane_names.h"
#include "record/sumo_files.h"
#include "record/vehicle_place.h"
#include "record/xml_file.h"
#include "sim/state/queries/vehicle_names.h"

namespace stopline {

namespace {

class FcdWriter : public RunWriter {
public:
    FcdWriter(const std::filesystem::path& file, const RecordingWindow& window, const Model& model)
        : model_(model),
          clock_(window, model.step_s),
          xml_(file, "fcd-export", "fcd_file.xsd"),
          lane_names_(model.graph, LaneNames::Style::sumo) {
        for (const GapPolicy& policy : model.policies) policies_.push_back(escape_xml(policy.settings.name));
    }

    void observe(const State& state) override {
        if (!clock_.is_due(state.tick)) return;
        xml_.add("    <timestep time=\"{:.2f}\">\n", model_.time_s(state.tick));
        for (int lane = 0; lane < static_cast<int>(state.blocks.size()); ++lane) {
            const LaneBlock& block = state.blocks[static_cast<std::size_t>(lane)];
            for (int slot = block.first; slot < block.past_last(); ++slot)
                add(state, lane, static_cast<std::size_t>(slot));
        }
        xml_.add("    </timestep>\n");
        ++frames_;
    }

    std::string finish() override {
        xml_.finish();
        return fmt::format("{} timesteps, {} rows", frames_, rows_);
    }

private:
    void add(const State& state, int lane, std::size_t slot) {
        const VehicleArrays& v = state.vehicles;
        const Pose pose = front_pose(model_, state, lane, slot);
        const LaneNames::Place place = lane_names_.front(state, lane, slot);
        const double north_deg = 90.0 - std::atan2(pose.sine, pose.cosine) * 180.0 / std::numbers::pi;
        xml_.add(
            "        <vehicle id=\"{}\" x=\"{:.2f}\" y=\"{:.2f}\" angle=\"{:.2f}\" type=\"{}\" speed=\"{:.2f}\" "
            "pos=\"{:.2f}\" lane=\"{}\" slope=\"{:.2f}\" acceleration=\"{:.2f}\"/>\n",
            escape_xml(vehicle_name(model_, v.itinerary_of(slot).trip, v.id[slot])), pose.point.x_m, pose.point.y_m,
            north_deg < 0.0 ? north_deg + 360.0 : north_deg, policies_[static_cast<std::size_t>(v.policy[slot])],
            v.speed_mps[slot], place.position_m, place.lane, slope_deg(lane), v.acceleration_mps2[slot]);
        ++rows_;
    }
    double slope_deg(int lane) const {
        return std::atan(model_.graph.lanes[static_cast<std::size_t>(lane)].gradient) * 180.0 / std::numbers::pi;
    }

    const Model& model_;
    FrameClock clock_;
    XmlFile xml_;
    LaneNames lane_names_;
    std::vector<std::string> policies_;
    std::int64_t frames_ = 0;
    std::int64_t rows_ = 0;
};

}  // namespace

std::unique_ptr<RunWriter> make_fcd_writer(const std::filesystem::path& file, const RecordingWindow& window,
                                           const Model& model) {
    return std::make_unique<FcdWriter>(file, window, model);
}

}  // namespace stopline

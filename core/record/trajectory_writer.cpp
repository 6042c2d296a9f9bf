#include "record/trajectory_writer.h"

#include <fmt/format.h>

#include "base/io/csv.h"
#include "record/lane_names.h"
#include "record/streamed_file.h"
#include "record/vehicle_place.h"
#include "sim/state/queries/vehicle_names.h"

namespace stopline {

namespace {

class TrajectoryWriter : public RunWriter {
public:
    TrajectoryWriter(const std::filesystem::path& file, const RecordingWindow& window, std::string population,
                     const Model& model, const std::string& header)
        : model_(model),
          clock_(window, model.step_s),
          population_(std::move(population)),
          lane_names_(model.graph, LaneNames::Style::plain),
          file_(file) {
        file_.write(header);
    }

    void observe(const State& state) override {
        if (!clock_.is_due(state.tick)) return;
        text_.clear();
        for (int lane = 0; lane < static_cast<int>(state.blocks.size()); ++lane) {
            const LaneBlock& block = state.blocks[static_cast<std::size_t>(lane)];
            for (int slot = block.first; slot < block.past_last(); ++slot)
                add(state, lane, static_cast<std::size_t>(slot));
        }
        file_.write(text_);
    }

    std::string finish() override {
        file_.commit();
        return fmt::format("{} rows", rows_);
    }

private:
    void add(const State& state, int lane, std::size_t slot) {
        const VehicleArrays& v = state.vehicles;
        const LaneNames::Place place = lane_names_.front(state, lane, slot);
        const Point front = front_pose(model_, state, lane, slot).point;
        fmt::format_to(std::back_inserter(text_), "{},{:.3f},{},{},{},{:.3f},{:.3f},{:.3f},{:.4f},{:.4f}\n",
                       population_, model_.time_s(state.tick),
                       csv_field(vehicle_name(model_, v.itinerary_of(slot).trip, v.id[slot])),
                       model_.policies[static_cast<std::size_t>(v.policy[slot])].settings.name, csv_field(place.lane),
                       place.position_m, front.x_m, front.y_m, v.speed_mps[slot], v.acceleration_mps2[slot]);
        ++rows_;
    }

    const Model& model_;
    FrameClock clock_;
    std::string population_;
    LaneNames lane_names_;
    StreamedFile file_;
    std::string text_;
    std::int64_t rows_ = 0;
};

}  // namespace

std::unique_ptr<RunWriter> make_trajectory_writer(const std::filesystem::path& file, const RecordingWindow& window,
                                                  const std::string& population, const Model& model,
                                                  const std::string& header) {
    return std::make_unique<TrajectoryWriter>(file, window, population, model, header);
}

}  // namespace stopline

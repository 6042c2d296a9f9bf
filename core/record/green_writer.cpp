#include "record/green_writer.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "base/io/csv.h"
#include "record/streamed_file.h"

namespace stopline {

namespace {

// Returns the names of the approach lanes of a signal group, separated by spaces. If the group controls only movements
// of lanes, returns the names of their connections.
std::string lanes_of(const LaneGraph& graph, int group) {
    std::string approach_lanes;
    std::string connections;
    for (const Lane& lane : graph.lanes) {
        const bool is_connection = lane.origin >= 0;
        if ((is_connection ? lane.movement_signal_group : lane.signal_group) != group) continue;
        std::string& names = is_connection ? connections : approach_lanes;
        if (!names.empty()) names += ' ';
        names += lane.name;
    }
    return approach_lanes.empty() ? connections : approach_lanes;
}

class GreenWriter : public RunWriter {
public:
    GreenWriter(const std::filesystem::path& file, const std::string& population, const Model& model)
        : step_s_(model.step_s), file_(file) {
        file_.write(kGreensHeader);
        for (int group = 0; group < model.signals.groups(); ++group) {
            const SignalPlans::Place& place = model.signals.place_of(group);
            const std::string lanes = lanes_of(model.graph, group);
            const bool is_signal = !lanes.empty() && !model.signals.never_changes(group);
            groups_.push_back({fmt::format("{},{},{},{}", population, place.signal, place.index, csv_field(lanes)),
                               place.is_known && is_signal});
        }
    }

    void observe(const State& state) override {
        for (std::size_t k = 0; k < groups_.size(); ++k) {
            Group& group = groups_[k];
            if (!group.is_known) continue;
            const bool is_green = state.signals.lights[k] == Light::green;
            if (is_green == group.is_green) continue;
            group.is_green = is_green;
            if (is_green) {
                group.start_tick = state.signals.since_tick[k];
                continue;
            }
            add_row(group, group.start_tick, state.signals.since_tick[k]);
            group.last_end_tick = state.signals.since_tick[k];
        }
    }

    std::string finish() override {
        for (const Group& group : groups_) {
            if (group.is_green) add_row(group, group.start_tick, kNone);
        }
        file_.commit();
        return fmt::format("{} greens", rows_);
    }

private:
    static constexpr std::int64_t kNone = kNoGreen;

    struct Group {
        std::string cells;  // the first cells of each row
        bool is_known = false;
        bool is_green = false;
        std::int64_t start_tick = kNone;     // start of the present green
        std::int64_t last_end_tick = kNone;  // end of the green before it
    };

    std::string time_cell(std::int64_t ticks) const {
        return fmt::format("{:.3f}", static_cast<double>(ticks) * step_s_);
    }

    void add_row(const Group& group, std::int64_t start_tick, std::int64_t end_tick) {
        const bool has_ended = end_tick != kNone;
        file_.write(fmt::format("{},{},{},{},{}\n", group.cells, time_cell(start_tick),
                                has_ended ? time_cell(end_tick) : "", has_ended ? time_cell(end_tick - start_tick) : "",
                                group.last_end_tick != kNone ? time_cell(start_tick - group.last_end_tick) : ""));
        ++rows_;
    }

    double step_s_;
    StreamedFile file_;
    std::vector<Group> groups_;  // [signal group]
    std::int64_t rows_ = 0;
};

}  // namespace

std::unique_ptr<RunWriter> make_green_writer(const std::filesystem::path& file, const std::string& population,
                                             const Model& model) {
    return std::make_unique<GreenWriter>(file, population, model);
}

}  // namespace stopline

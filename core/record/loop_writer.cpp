#include <algorithm>

#include "record/sumo_files.h"
#include "record/xml_file.h"

namespace stopline {

namespace {

constexpr double kHour_s = 3600.0;

const char* name_of(Detector::Kind kind) {
    switch (kind) {
        case Detector::Kind::stop_line:
            return "stop_line";
        case Detector::Kind::zone:
            return "zone";
        case Detector::Kind::exit:
            return "exit";
        case Detector::Kind::middle:
            return "middle";
        case Detector::Kind::loop:
            return "loop";
    }
    return "";
}

class LoopWriter : public RunWriter {
public:
    LoopWriter(const std::filesystem::path& file, double interval_s, const Model& model)
        : model_(model),
          every_(std::max<std::int64_t>(to_ticks(interval_s, model.step_s), 1)),
          xml_(file, "detector", "det_e1_file.xsd"),
          loops_(model.detectors.size()) {
        for (const Detector& detector : model.detectors) names_.push_back(xml_escaped(name_of_loop(detector)));
    }

    void look(const State& state) override {
        for (; crossing_ < state.crossings.size(); ++crossing_) note(state.crossings[crossing_]);
        if (state.tick == begin_) return;
        for (std::size_t k = 0; k < loops_.size(); ++k) {
            if (!names_[k].empty()) loops_[k].occupied += is_covered(state, k) ? 1 : 0;
        }
        if ((state.tick - begin_) % every_ == 0) write_interval(state.tick);
        last_ = state.tick;
    }

    std::string finish() override {
        if (last_ > begin_) write_interval(last_);
        xml_.finish();
        const auto placed = std::count_if(names_.begin(), names_.end(), [](auto& name) { return !name.empty(); });
        return fmt::format("{} loops, {} rows", placed, rows_);
    }

private:
    struct Loop {
        int passed = 0;
        double speeds_mps = 0.0;
        double slownesses_spm = 0.0;
        double lengths_m = 0.0;
        std::int64_t occupied = 0;  // steps
    };

    std::string name_of_loop(const Detector& detector) const {
        if (detector.loop >= 0) return model_.loop_names[static_cast<std::size_t>(detector.loop)];
        if (detector.lane < 0) return {};  // trips begin or end there: that is no place
        const std::string zone = detector.zone >= 0 ? std::to_string(detector.zone) : "";
        return fmt::format("{}_{}{}", model_.graph.lanes[static_cast<std::size_t>(detector.lane)].name,
                           name_of(detector.kind), zone);
    }

    void note(const Crossing& crossing) {
        constexpr double kSlowest_mps = 0.01;
        Loop& loop = loops_[static_cast<std::size_t>(crossing.detector)];
        const double speed_mps = std::max(static_cast<double>(crossing.speed_mps), kSlowest_mps);
        ++loop.passed;
        loop.speeds_mps += speed_mps;
        loop.slownesses_spm += 1.0 / speed_mps;
        loop.lengths_m += static_cast<double>(crossing.length_m);
    }

    // Front beyond it and rear before it: on its lane, or with the front on one that follows.
    bool is_covered(const State& state, std::size_t detector) const {
        const VehicleArrays& v = state.vehicles;
        const double line_m = model_.detectors[detector].position_m;
        const auto lane = static_cast<std::size_t>(model_.detectors[detector].lane);
        const LaneBlock& block = state.blocks[lane];
        for (int slot = block.first; slot < block.stop(); ++slot) {
            const auto i = static_cast<std::size_t>(slot);
            if (v.position_m[i] < line_m) break;
            if (v.position_m[i] - static_cast<double>(v.length_m[i]) < line_m) return true;
        }
        const double end_m = model_.graph.lanes[lane].length_m;
        for (const int next : model_.graph.lanes[lane].next) {
            const LaneBlock& beyond = state.blocks[static_cast<std::size_t>(next)];
            if (beyond.count == 0 || model_.graph.lanes[static_cast<std::size_t>(next)].origin < 0) continue;
            const auto i = static_cast<std::size_t>(beyond.last());
            if (end_m + v.position_m[i] - static_cast<double>(v.length_m[i]) < line_m) return true;
        }
        return false;
    }

    void write_interval(std::int64_t tick) {
        const auto steps = static_cast<double>(tick - begin_);
        const double from_s = model_.time_s(begin_);
        const double to_s = model_.time_s(tick);
        for (std::size_t k = 0; k < loops_.size(); ++k) {
            if (names_[k].empty()) continue;
            const Loop& loop = loops_[k];
            const double passed = loop.passed;
            const bool any = loop.passed > 0;
            xml_.add(
                "    <interval begin=\"{:.2f}\" end=\"{:.2f}\" id=\"{}\" nVehContrib=\"{}\" flow=\"{:.2f}\" "
                "occupancy=\"{:.2f}\" speed=\"{:.2f}\" harmonicMeanSpeed=\"{:.2f}\" length=\"{:.2f}\" "
                "nVehEntered=\"{}\"/>\n",
                from_s, to_s, names_[k], loop.passed, passed * kHour_s / (to_s - from_s),
                100.0 * static_cast<double>(loop.occupied) / steps, any ? loop.speeds_mps / passed : -1.0,
                any ? passed / loop.slownesses_spm : -1.0, any ? loop.lengths_m / passed : -1.0, loop.passed);
            ++rows_;
        }
        std::fill(loops_.begin(), loops_.end(), Loop{});
        begin_ = tick;
    }

    const Model& model_;
    std::int64_t every_;
    XmlFile xml_;
    std::vector<Loop> loops_;  // [detector]
    std::vector<std::string> names_;
    std::size_t crossing_ = 0;  // the first that was not looked at
    std::int64_t begin_ = 0;    // of the interval
    std::int64_t last_ = 0;
    std::int64_t rows_ = 0;
};

}  // namespace

std::unique_ptr<RunWriter> make_loop_writer(const std::filesystem::path& file, double interval_s, const Model& model) {
    return std::make_unique<LoopWriter>(file, interval_s, model);
}

}  // namespace stopline

#include <algorithm>

#include "base/io/escape.h"
#include "base/units.h"
#include "record/sumo_files.h"
#include "record/xml_file.h"
#include "sim/state/queries/covered_detector.h"

namespace stopline {

namespace {

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
        case Detector::Kind::signal:
            return "signal";
    }
    return "";
}

class LoopWriter : public RunWriter {
public:
    LoopWriter(const std::filesystem::path& file, double interval_s, const Model& model)
        : model_(model),
          step_s_(model.step_s),
          interval_ticks_(std::max<std::int64_t>(to_ticks(interval_s, model.step_s), 1)),
          xml_(file, "detector", "det_e1_file.xsd"),
          loops_(model.detectors.size()) {
        for (const Detector& detector : model.detectors) names_.push_back(escape_xml(name_of_loop(detector)));
    }

    void observe(const State& state) override {
        for (; next_crossing_ < state.records.crossings.size(); ++next_crossing_)
            add_crossing(state.records.crossings[next_crossing_]);
        if (state.tick == interval_begin_) return;
        for (std::size_t k = 0; k < loops_.size(); ++k) {
            if (!names_[k].empty()) loops_[k].occupied_steps += is_covered(model_, state, k) ? 1 : 0;
        }
        if ((state.tick - interval_begin_) % interval_ticks_ == 0) write_interval(state.tick);
        last_tick_ = state.tick;
    }

    std::string finish() override {
        if (last_tick_ > interval_begin_) write_interval(last_tick_);
        xml_.finish();
        const auto loops = std::count_if(names_.begin(), names_.end(), [](auto& name) { return !name.empty(); });
        return fmt::format("{} loops, {} rows", loops, rows_);
    }

private:
    struct Loop {
        int passages = 0;
        double sum_of_speeds_mps = 0.0;
        double sum_of_inverse_speeds_spm = 0.0;
        double sum_of_lengths_m = 0.0;
        std::int64_t occupied_steps = 0;
    };

    std::string name_of_loop(const Detector& detector) const {
        if (detector.loop >= 0) return model_.loop_names[static_cast<std::size_t>(detector.loop)];
        if (detector.lane < 0) return {};  // a detector without a position, which counts the starts or ends of trips
        const std::string zone = detector.zone >= 0 ? std::to_string(detector.zone) : "";
        return fmt::format("{}_{}{}", model_.graph.lanes[static_cast<std::size_t>(detector.lane)].name,
                           name_of(detector.kind), zone);
    }

    void add_crossing(const Crossing& crossing) {
        constexpr double kMinSpeed_mps = 0.01;
        Loop& loop = loops_[static_cast<std::size_t>(crossing.detector)];
        const double speed_mps = std::max(static_cast<double>(crossing.speed_mps), kMinSpeed_mps);
        ++loop.passages;
        loop.sum_of_speeds_mps += speed_mps;
        loop.sum_of_inverse_speeds_spm += 1.0 / speed_mps;
        loop.sum_of_lengths_m += static_cast<double>(crossing.length_m);
    }

    void write_interval(std::int64_t tick) {
        const auto steps = static_cast<double>(tick - interval_begin_);
        const double from_s = static_cast<double>(interval_begin_) * step_s_;
        const double to_s = static_cast<double>(tick) * step_s_;
        for (std::size_t k = 0; k < loops_.size(); ++k) {
            if (names_[k].empty()) continue;
            const Loop& loop = loops_[k];
            const double passages = loop.passages;
            const bool has_passages = loop.passages > 0;
            xml_.add(
                "    <interval begin=\"{:.2f}\" end=\"{:.2f}\" id=\"{}\" nVehContrib=\"{}\" flow=\"{:.2f}\" "
                "occupancy=\"{:.2f}\" speed=\"{:.2f}\" harmonicMeanSpeed=\"{:.2f}\" length=\"{:.2f}\" "
                "nVehEntered=\"{}\"/>\n",
                from_s, to_s, names_[k], loop.passages, passages * kSecondsPerHour / (to_s - from_s),
                100.0 * static_cast<double>(loop.occupied_steps) / steps,
                has_passages ? loop.sum_of_speeds_mps / passages : -1.0,
                has_passages ? passages / loop.sum_of_inverse_speeds_spm : -1.0,
                has_passages ? loop.sum_of_lengths_m / passages : -1.0, loop.passages);
            ++rows_;
        }
        std::fill(loops_.begin(), loops_.end(), Loop{});
        interval_begin_ = tick;
    }

    const Model& model_;  // finish() must not use the model, which may be destroyed by then
    double step_s_;
    std::int64_t interval_ticks_;
    XmlFile xml_;
    std::vector<Loop> loops_;  // [detector]
    std::vector<std::string> names_;
    std::size_t next_crossing_ = 0;    // index of the first crossing that is not counted yet
    std::int64_t interval_begin_ = 0;  // tick at which the current interval began
    std::int64_t last_tick_ = 0;
    std::int64_t rows_ = 0;
};

}  // namespace

std::unique_ptr<RunWriter> make_loop_writer(const std::filesystem::path& file, double interval_s, const Model& model) {
    return std::make_unique<LoopWriter>(file, interval_s, model);
}

}  // namespace stopline

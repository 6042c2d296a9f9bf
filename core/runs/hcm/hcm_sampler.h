// Records the intervals of red and green, passages, delays and queues of all lanes with a signal during a run, for the
// report by the Highway Capacity Manual (measure/hcm.h). Exists only in runs with `measure.hcm: on`.
#pragma once

#include <cstdint>
#include <vector>

#include "base/containers/index.h"
#include "measure/hcm.h"
#include "runs/hcm/signal_cycles.h"
#include "scenario/scenario.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

inline bool asks_for_hcm(const Scenario& scenario) { return scenario.measure.hcm == "on"; }

class HcmSampler {
public:
    // The model must outlive the sampler, and it must record the crossings of stop lines (prepare()).
    HcmSampler(const Scenario& scenario, const Model& model);

    // Lets the model record the crossings of stop lines if the scenario asks for the report.
    static void prepare(const Scenario& scenario, Model& model);

    // Must be called before every step, and once after the last one.
    void sample(const State& state);
    std::vector<HcmRow> rows(const TimeWindow& window) const;

private:
    // The memory of one vehicle.
    struct Track {
        int record = -1;          // lane that it approaches; -1: none
        int last_record = -1;     // lane whose stop line it passed last, while it still accelerates; -1: none
        std::size_t passage = 0;  // index in HcmRecord::passages of last_record
        double delay_s = 0.0;     // on the way to the stop line
        int stops = 0;
        bool is_slow = false;  // slower than kQueuedSpeed_mps, and since then not faster than twice this speed
        bool has_queued = false;
    };
    // The interval of a lane that has not ended yet.
    struct OpenInterval {
        bool has_begun = false;
        HcmInterval interval;
    };
    // The cycles of the signal of a lane (SignalCycles).
    struct LaneCycles {
        std::int64_t present = SignalCycles::kNoCycle;        // at the last sample
        std::int64_t of_last_green = SignalCycles::kNoCycle;  // in which the last green of the lane ended
    };

    void note_lights(const State& state);
    void note_passages(const State& state);
    void note_teleports(const State& state);
    void end_green_interval(const State& state, int record, double now_s);
    void note_cycles(const State& state);
    void begin_interval(const State& state, int record, double now_s, std::int64_t cycle);
    int group_of(int record) const { return model_.graph.lanes[at(records_[at(record)].lane)].signal_group; }
    void visit_lane(const State& state, int lane);
    void approach_line(Track& track, int record, double to_line_m, double speed_mps, double lost_s, double length_m);
    int queued_before_line(const State& state, int record) const;
    int present_before_line(const State& state, int record) const;
    Track& track_of(int vehicle);

    const Model& model_;
    std::int64_t sample_ticks_;
    double sample_s_;
    double free_flow_share_;  // free-flow speed as a share of the speed limit
    std::vector<HcmRecord> records_;
    std::vector<OpenInterval> open_;                  // [record]
    std::vector<LaneCycles> lane_cycles_;             // [record]
    std::vector<int> record_of_;                      // [lane] index in records_; -1: no stop line
    std::vector<std::vector<int>> records_of_group_;  // [signal group]
    std::vector<Light> lights_;                       // [signal group] at the last sample
    SignalCycles cycles_;
    std::vector<Track> tracks_;  // [vehicle]
    std::size_t next_crossing_ = 0;
    std::size_t next_rule_use_ = 0;
};

}  // namespace stopline

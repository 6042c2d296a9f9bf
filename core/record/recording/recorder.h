// Writes the recording of a run (recording_format.h) while the run continues. The thread of the simulation only copies
// the state. A second thread encodes and compresses the copies and writes the file. The file appears after finish().
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/io/replaced_file.h"
#include "record/recording/compression.h"
#include "record/recording/frame_clock.h"
#include "record/recording/frame_encoder.h"
#include "record/recording/recording_header.h"
#include "record/recording/snapshot_worker.h"

namespace stopline {

struct RecordingSize {
    std::int64_t frames = 0;
    std::int64_t vehicle_states = 0;
    std::size_t bytes = 0;

    double bytes_per_state() const {
        return static_cast<double>(bytes) / static_cast<double>(vehicle_states > 0 ? vehicle_states : 1);
    }
};

class Recorder {
public:
    // The recorder keeps no reference to the model. All functions throw InputError if the file cannot be written.
    // Because the second thread writes the file, observe() can report a failed write with a delay of some frames.
    Recorder(const std::filesystem::path& file, const RecordingWindow& window, const RunOrigin& origin,
             const Model& model);

    // Records the state if a frame is due. Call it before each step, and once after the last step.
    void observe(const State& state) {
        if (clock_.is_due(state.tick)) record(state);
    }
    // Completes the file and returns its size.
    RecordingSize finish();

private:
    void record(const State& state);
    void encode(const Snapshot& shot);
    void write_section(std::string_view tag, std::string_view bytes);
    void write_frames();

    std::int64_t watch_ticks_;
    FrameClock clock_;
    FrameGrid grid_;
    SnapshotTaker taker_;
    int snapshots_in_section_ = 0;
    // Tick of the update of the delay causes that was copied into a snapshot last.
    std::int64_t cause_tick_ = -1;
    // Only the second thread uses the next six members until finish() has stopped it.
    ReplacedFile file_;
    Compressor compressor_;
    FrameEncoder encoder_;
    std::int64_t frames_ = 0;
    int frames_in_section_ = 0;
    std::string section_;
    SnapshotWorker worker_;  // last member: its destructor ends the thread before the other members are destroyed
};

}  // namespace stopline

// Writes the recording of one run while it runs (recording_format.h). The file appears once the run has been finished.
// The run only copies what is to be recorded; encoding, compressing and writing are done by a thread of the recorder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/replaced_file.h"
#include "record/compression.h"
#include "record/frame_clock.h"
#include "record/frame_encoder.h"
#include "record/recording_header.h"
#include "record/snapshot_worker.h"

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
    // Keeps no reference to the model. Throws InputError where the file cannot be written, as all below,
    // perhaps some frames later.
    Recorder(const std::filesystem::path& file, const RecordingWindow& window, const RunOrigin& origin,
             const Model& model);

    // Before each step, and once after the last.
    void look(const State& state) {
        if (clock_.is_due(state.tick)) record(state);
    }
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
    int taken_in_section_ = 0;
    std::int64_t look_tick_ = -1;  // of the causes in the last snapshot that has them
    // The worker's, until it has finished.
    ReplacedFile file_;
    Compressor compressor_;
    FrameEncoder encoder_;
    std::int64_t frames_ = 0;
    int in_section_ = 0;
    std::string section_;
    SnapshotWorker worker_;  // last: it ends before what it works with
};

}  // namespace stopline

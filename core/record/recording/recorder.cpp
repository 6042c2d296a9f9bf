#include "record/recording/recorder.h"

#include "record/recording/bytes.h"
#include "record/recording/recording_format.h"

namespace stopline {

Recorder::Recorder(const std::filesystem::path& file, const RecordingWindow& window, const RunOrigin& origin,
                   const Model& model)
    : watch_ticks_(model.rules.watch_ticks),
      clock_(window, model.step_s),
      grid_(make_frame_grid(model, clock_)),
      taker_(model, grid_),
      file_(file),
      encoder_(model, grid_),
      worker_([this](const Snapshot& snapshot) { encode(snapshot); }) {
    std::string begin(kRecordingMagic);
    put_number(begin, kRecordingVersion);
    put_number(begin, kByteOrderMark);
    file_.write(begin);
    write_section(kHeadTag, recording_header(model, origin, grid_));
}

void Recorder::record(const State& state) {
    const std::int64_t cause_tick = last_cause_tick(watch_ticks_, state.tick);
    const bool begins_section = snapshots_in_section_ == 0;
    if (begins_section) taker_.start_section();
    taker_.take(state, begins_section || cause_tick != cause_tick_, worker_.acquire());
    worker_.submit();
    cause_tick_ = cause_tick;
    snapshots_in_section_ = (snapshots_in_section_ + 1) % kFramesInSection;
}

void Recorder::encode(const Snapshot& snapshot) {
    if (frames_in_section_ == 0) encoder_.start_section();
    encoder_.append(snapshot, section_);
    ++frames_in_section_;
    ++frames_;
    if (frames_in_section_ == kFramesInSection) write_frames();
}

void Recorder::write_frames() {
    std::string begin;
    put_number(begin, static_cast<std::uint32_t>(frames_ - frames_in_section_));
    put_number(begin, static_cast<std::uint16_t>(frames_in_section_));
    section_.insert(0, begin);
    write_section(kFramesTag, section_);
    section_.clear();
    frames_in_section_ = 0;
}

void Recorder::write_section(std::string_view tag, std::string_view bytes) {
    const std::string_view compressed = compressor_.compress(bytes);
    std::string begin(tag);
    put_number(begin, static_cast<std::uint32_t>(compressed.size()));
    put_number(begin, static_cast<std::uint32_t>(bytes.size()));
    file_.write(begin);
    file_.write(compressed);
}

RecordingSize Recorder::finish() {
    worker_.finish();
    if (frames_in_section_ > 0) write_frames();
    std::string end;
    put_number(end, static_cast<std::uint64_t>(frames_));
    put_number(end, static_cast<std::uint64_t>(encoder_.vehicle_states()));
    write_section(kEndTag, end);
    file_.commit();
    return {frames_, encoder_.vehicle_states(), file_.size()};
}

}  // namespace stopline

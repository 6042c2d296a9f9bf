// Reads a recording section by section and checks that it is whole. What is wrong with a file is an InputError that names it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "record/recording_header.h"

namespace stopline {

// About a minute of frames, unpacked; FrameDecoder reads it.
struct RecordedSection {
    std::int64_t first_frame = 0;
    int frames = 0;
    std::string bytes;
};

class RecordingReader {
public:
    explicit RecordingReader(const std::filesystem::path& file);

    const RecordedRun& run() const { return run_; }
    const std::string& header() const { return header_; }  // JSON
    // False after the last one, which is followed by a sound end.
    bool next(RecordedSection& section);
    std::int64_t frames() const { return frames_; }  // read so far

    [[noreturn]] void fail(const std::string& what) const;

private:
    std::string read(std::size_t size);
    std::string read_section(std::string& tag);
    void check_begin();
    void check_end(const std::string& bytes);

    std::filesystem::path path_;
    std::ifstream stream_;
    std::string header_;
    RecordedRun run_;
    std::int64_t frames_ = 0;
};

}  // namespace stopline

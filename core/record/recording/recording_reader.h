// Reads a recording section by section. If the recording is damaged or incomplete, all functions throw an InputError
// that names the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "record/recording/recording_header.h"

namespace stopline {

// The unpacked frames of one section, for FrameDecoder.
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
    // Reads the next section of frames. After the last section it checks that the file is complete and returns false.
    bool next(RecordedSection& section);
    // Returns the number of frames read so far.
    std::int64_t frames() const { return frames_; }

    // Throws InputError with the path and the message.
    [[noreturn]] void fail(const std::string& what) const;

private:
    std::string read(std::size_t size);
    std::string read_section(std::string& tag);
    void check_begin();
    void check_end(const std::string& bytes);

    std::filesystem::path path_;
    std::ifstream stream_;
    std::uintmax_t remaining_ = 0;  // bytes that have not been read
    std::string header_;
    RecordedRun run_;
    std::int64_t frames_ = 0;
};

}  // namespace stopline

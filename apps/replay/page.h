// Builds one HTML page from a recording. The page contains the files of apps/replay/page and the recorded data, and
// needs no network connection.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>

#include "record/recording/recording_reader.h"

namespace stopline {

struct ReplayWindow {
    double from_s = 0.0;
    double until_s = std::numeric_limits<double>::infinity();
};

struct ReplayPage {
    std::string html;
    std::int64_t frames = 0;
    double from_s = 0.0;            // time of the first frame
    double to_s = 0.0;              // time of the last frame
    std::uint32_t max_present = 0;  // maximum number of vehicles in the network
};

// Reads the whole recording and checks every frame. A recording consists of sections of up to 128 frames. The page gets
// all sections that have a frame within the window. Calls `on_frames` with the number of frames read so far. Throws
// Interrupted if `on_frames` returns false. Throws InputError if the recording is damaged or the page would be too
// large for a browser.
ReplayPage make_replay_page(RecordingReader& reader, const ReplayWindow& window,
                            const std::function<bool(std::int64_t)>& on_frames);

}  // namespace stopline

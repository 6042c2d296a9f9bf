// A recording as one HTML page that needs nothing else: the files of apps/replay/page with the sections of the recording.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>

#include "record/recording_reader.h"

namespace stopline {

struct ReplayWindow {
    double from_s = 0.0;
    double until_s = std::numeric_limits<double>::infinity();
};

struct ReplayPage {
    std::string html;
    std::int64_t frames = 0;
    double from_s = 0.0;
    double to_s = 0.0;
    std::uint32_t most_present = 0;
};

// Reads to the end and checks every frame. Whole sections, about a minute each, that have a frame within the window are taken.
// Throws InputError where the recording is damaged, or the page would be too large for a browser. `on_frames` gets the frames
// read and returns false to stop: throws Interrupted.
ReplayPage make_replay_page(RecordingReader& reader, const ReplayWindow& window,
                            const std::function<bool(std::int64_t)>& on_frames);

}  // namespace stopline

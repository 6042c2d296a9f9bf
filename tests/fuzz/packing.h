// Packed inputs: gzip, and the sections of recordings.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace stopline::fuzz {

bool is_gzip(std::string_view bytes);
// Returns the unpacked text, at most 1 MB of it. Damaged data give the text before the damage.
std::string unpack_gzip(std::string_view bytes);
std::string pack_gzip(std::string_view text);

// A section of a recording (recording_format.h).
struct Section {
    std::string tag;
    std::string bytes;  // unpacked
};
// Returns the sections up to the first damage.
std::vector<Section> sections_of(std::string_view recording);
// Returns a recording with valid sizes and checksums.
std::string pack_recording(const std::vector<Section>& sections);

}  // namespace stopline::fuzz

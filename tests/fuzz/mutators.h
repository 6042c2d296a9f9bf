// Changes of inputs that keep most of their structure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/targets.h"

namespace stopline::fuzz {

// Random numbers of one change.
class Random {
public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}

    // Returns a number from 0 to `count` - 1. `count` must not be 0.
    std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(engine_); }
    template <class List>
    const auto& one_of(const List& list) {
        return list[below(list.size())];
    }

private:
    std::minstd_rand engine_;
};

// Changes, adds, removes, copies or moves lines of a YAML text. Takes new keys and values from the field tables.
void mutate_yaml(std::string& text, Random& random, ByteMutator mutate_bytes);
// Changes a list of overrides, one in each line. Takes paths and values from the field tables.
void mutate_overrides(std::string& text, Random& random, ByteMutator mutate_bytes);
// Changes, adds, removes, copies or moves elements and attributes of an XML text. Unpacks a gzipped text before the
// change and packs it again.
void mutate_xml(std::string& text, Random& random, ByteMutator mutate_bytes);
// Unpacks the sections of a recording, changes one of them, and packs them again with valid sizes and checksums.
void mutate_recording(std::string& bytes, Random& random, ByteMutator mutate_bytes);

}  // namespace stopline::fuzz

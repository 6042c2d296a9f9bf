#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/mutators.h"
#include "fuzz/packing.h"

namespace stopline::fuzz {

namespace {

constexpr std::array<std::string_view, 16> kNumbers{
    "0",           "1",          "-1",   "1e300", "-1e300", "1e-300", "0.1",  "2147483647",
    "-2147483648", "4294967296", "null", "\"x\"", "[]",     "{}",     "true", "32768"};

// Replaces a number of the JSON header.
void change_header(std::string& json, Random& random) {
    constexpr std::string_view kDigits = "-.0123456789e";
    std::vector<std::size_t> numbers;
    for (std::size_t k = 0; k + 1 < json.size(); ++k) {
        const bool is_before = json[k] == ':' || json[k] == ',' || json[k] == '[';
        if (is_before && kDigits.find(json[k + 1]) != std::string_view::npos) numbers.push_back(k + 1);
    }
    if (numbers.empty()) return;
    const std::size_t begin = random.one_of(numbers);
    const std::size_t end = std::min(json.find_first_not_of(kDigits, begin), json.size());
    json.replace(begin, end - begin, random.one_of(kNumbers));
}

}  // namespace

void mutate_recording(std::string& bytes, Random& random, ByteMutator mutate_bytes) {
    std::vector<Section> sections = sections_of(bytes);
    if (sections.empty()) return mutate_bytes(bytes);
    const std::size_t k = random.below(sections.size());
    switch (random.below(8)) {
        case 0:
            std::swap(sections[k], sections[random.below(sections.size())]);
            break;
        case 1:
            sections.erase(sections.begin() + static_cast<std::ptrdiff_t>(k));
            break;
        case 2:
            sections.push_back(sections[k]);
            break;
        case 3:
        case 4:
            change_header(sections.front().bytes, random);
            break;
        default:
            mutate_bytes(sections[k].bytes);
            break;
    }
    bytes = pack_recording(sections);
}

}  // namespace stopline::fuzz

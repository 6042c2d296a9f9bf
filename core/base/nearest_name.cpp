#include "base/nearest_name.h"

#include <algorithm>
#include <numeric>

namespace stopline {
namespace {

constexpr std::size_t kMaxShownCharacters = 60;
constexpr std::size_t kMaxComparedCharacters = 100;  // a longer text is no misspelt name, so it is not compared

char lower(char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); }

// Returns the smallest number of edits that turn `a` into `b`, ignoring case (optimal string alignment distance). An
// edit inserts, deletes or replaces one character, or swaps two adjacent characters.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before_last(b.size() + 1);
    std::vector<std::size_t> last(b.size() + 1);
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replace = last[j - 1] + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
            row[j] = std::min({replace, last[j] + 1, row[j - 1] + 1});
            const bool swapped =
                i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
            if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
        }
        before_last.swap(last);
        last.swap(row);
    }
    return last[b.size()];
}

}  // namespace

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
    if (name.size() > kMaxComparedCharacters) return {};
    std::string nearest;
    std::size_t smallest = std::max<std::size_t>(1, name.size() / 3) + 1;
    for (const std::string& candidate : candidates) {
        const std::size_t distance = edit_distance(name, candidate);
        if (distance >= smallest || distance >= std::max(name.size(), candidate.size())) continue;
        smallest = distance;
        nearest = candidate;
    }
    return nearest;
}

std::string known_names_hint(std::string_view name, const std::vector<std::string>& candidates,
                             std::size_t max_listed) {
    const std::string nearest = nearest_name(name, candidates);
    const std::size_t listed = std::min(candidates.size(), max_listed);
    std::string list = candidates.empty()
                           ? "none"
                           : joined({candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(listed)});
    if (listed < candidates.size()) list += " and " + std::to_string(candidates.size() - listed) + " more";
    return (nearest.empty() ? "; known: " : "; did you mean '" + nearest + "'? Known: ") + list;
}

std::string joined(const std::vector<std::string>& names, std::string_view between) {
    std::string text;
    for (const std::string& name : names) {
        if (!text.empty()) text += between;
        text += name;
    }
    return text;
}

std::string shortened(std::string_view text) {
    std::string shown;
    for (const char c : text.substr(0, kMaxShownCharacters)) {
        const auto byte = static_cast<unsigned char>(c);
        shown += byte < 0x20 || byte == 0x7F ? ' ' : c;
    }
    if (text.size() <= kMaxShownCharacters) return shown;
    // If the cut is inside a UTF-8 character, remove the first part of this character, too.
    while (!shown.empty() && (static_cast<unsigned char>(text[shown.size()]) & 0xC0u) == 0x80u) shown.pop_back();
    return shown + "...";
}

}  // namespace stopline

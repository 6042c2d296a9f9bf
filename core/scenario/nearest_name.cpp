#include "scenario/nearest_name.h"

#include <algorithm>
#include <numeric>

namespace stopline {
namespace {

constexpr std::size_t kShownCharacters = 60;
constexpr std::size_t kComparedCharacters = 100;  // longer texts are not misspelt names

char lower(char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); }

// Edits (insert, delete, replace, swap neighbours) that turn one text into the other: the optimal string alignment
// distance, row by row.
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
    if (name.size() > kComparedCharacters) return {};
    std::string nearest;
    std::size_t least = std::max<std::size_t>(1, name.size() / 3) + 1;
    for (const std::string& candidate : candidates) {
        const std::size_t distance = edit_distance(name, candidate);
        if (distance >= least || distance >= std::max(name.size(), candidate.size())) continue;
        least = distance;
        nearest = candidate;
    }
    return nearest;
}

std::string known_names(std::string_view name, const std::vector<std::string>& candidates, std::size_t most) {
    const std::string nearest = nearest_name(name, candidates);
    const std::size_t listed = std::min(candidates.size(), most);
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
    for (const char c : text.substr(0, kShownCharacters)) {
        const auto byte = static_cast<unsigned char>(c);
        shown += byte < 0x20 || byte == 0x7F ? ' ' : c;
    }
    if (text.size() <= kShownCharacters) return shown;
    // Not in the middle of a UTF-8 sequence.
    while (!shown.empty() && (static_cast<unsigned char>(text[shown.size()]) & 0xC0u) == 0x80u) shown.pop_back();
    return shown + "...";
}

}  // namespace stopline

#include "scenario/schema/report.h"

#include <algorithm>
#include <tuple>

#include "base/input_error.h"
#include "base/io/printable.h"

namespace stopline {
namespace {

constexpr std::size_t kErrorsShown = 20;

std::string label(const Place& place) { return place.source ? place.source->label : ""; }

}  // namespace

void Report::error(const Place& place, const std::string& message) { errors_.push_back({place, message}); }

void Report::warn(const Place& place, const std::string& message) { warnings_.push_back({place, message}); }

std::vector<std::string> Report::sorted_lines(std::vector<Entry> entries) {
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return std::tuple(label(a.place), a.place.line, a.place.column) <
               std::tuple(label(b.place), b.place.line, b.place.column);
    });
    std::vector<std::string> lines;
    for (const Entry& entry : entries) lines.push_back(printable_text(to_string(entry.place) + ": " + entry.message));
    return lines;
}

void Report::throw_if_any() const {
    if (errors_.empty()) return;
    const std::vector<std::string> lines = sorted_lines(errors_);
    const std::size_t shown = std::min(lines.size(), kErrorsShown);
    std::string text;
    for (std::size_t i = 0; i < shown; ++i) text += (i == 0 ? "" : "\n") + lines[i];
    if (lines.size() > shown) text += "\n... and " + std::to_string(lines.size() - shown) + " more errors";
    throw InputError(text);
}

std::vector<std::string> Report::warnings() const {
    std::vector<std::string> unique;
    for (std::string& line : sorted_lines(warnings_)) {
        if (std::find(unique.begin(), unique.end(), line) == unique.end()) unique.push_back(std::move(line));
    }
    return unique;
}

Place Report::place_of(std::string path) const {
    for (;;) {
        const auto found = places_.find(path);
        if (found != places_.end()) return found->second;
        if (path.empty()) return {};
        const auto cut = path.find_last_of(".[");
        path.resize(cut == std::string::npos ? 0 : cut);
    }
}

void Checker::error(const std::string& relative_path, const std::string& message) {
    const std::string path = full_path(relative_path);
    report_.error(report_.place_of(path), "field '" + path + "': " + message);
}

std::string Checker::full_path(const std::string& relative_path) const { return join_path(path_, relative_path); }

std::string join_path(const std::string& parent, const std::string& name) {
    if (parent.empty()) return name;
    if (name.empty() || name.front() == '[') return parent + name;
    return parent + "." + name;
}

}  // namespace stopline

#include "scenario/report.h"

#include "base/input_error.h"

namespace stopline {
namespace {
constexpr std::size_t kErrorsShown = 20;
}

void Report::error(const Place& place, const std::string& message) { error(to_string(place) + ": " + message); }

void Report::error(const std::string& whole_message) {
    ++count_;
    if (lines_.size() < kErrorsShown) lines_.push_back(whole_message);
}

void Report::throw_if_any() const {
    if (count_ == 0) return;
    std::string text;
    for (const std::string& line : lines_) text += (text.empty() ? "" : "\n") + line;
    if (count_ > lines_.size()) text += "\n... and " + std::to_string(count_ - lines_.size()) + " more errors";
    throw InputError(text);
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
    const std::string path = full(relative_path);
    report_.error(report_.place_of(path), "field '" + path + "': " + message);
}

std::string Checker::full(const std::string& relative_path) const { return join_path(path_, relative_path); }

std::string join_path(const std::string& parent, const std::string& name) {
    if (parent.empty()) return name;
    if (name.empty() || name.front() == '[') return parent + name;
    return parent + "." + name;
}

}  // namespace stopline

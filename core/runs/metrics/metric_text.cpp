#include "runs/metrics/metric_text.h"

#include <algorithm>
#include <array>
#include <utility>

namespace stopline {

void ConsoleHead::add(std::string_view heading, std::string_view unit) {
    std::vector<std::string> lines{std::string(unit)};
    for (std::size_t end = heading.size(); end != std::string_view::npos;) {
        const std::size_t line_break = end == 0 ? std::string_view::npos : heading.rfind('\n', end - 1);
        const std::size_t begin = line_break == std::string_view::npos ? 0 : line_break + 1;
        lines.emplace_back(heading.substr(begin, end - begin));
        end = line_break;
    }
    columns_.push_back(std::move(lines));
    is_bar_.push_back(false);
}

void ConsoleHead::add_bar() {
    columns_.emplace_back();
    is_bar_.push_back(true);
}

std::vector<std::vector<std::string>> ConsoleHead::rows() const {
    std::size_t height = 1;
    for (const std::vector<std::string>& lines : columns_) height = std::max(height, lines.size());
    std::vector<std::vector<std::string>> rows;
    for (std::size_t line = height; line-- > 0;) {
        std::vector<std::string> row{line == 0 ? "population" : ""};
        for (std::size_t k = 0; k < columns_.size(); ++k) {
            const std::vector<std::string>& lines = columns_[k];
            row.push_back(is_bar_[k] ? "|" : line < lines.size() ? lines[line] : "");
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

std::string with_key(std::string_view text, std::string_view placeholder, std::string_view key) {
    std::string replaced(text);
    for (std::size_t at = replaced.find(placeholder); at != std::string::npos;
         at = replaced.find(placeholder, at + key.size())) {
        replaced.replace(at, placeholder.size(), key);
    }
    return replaced;
}

std::string_view key_in(std::string_view name, std::string_view pattern, std::string_view placeholder) {
    const std::size_t at = pattern.find(placeholder);
    const std::string_view begin = pattern.substr(0, at);
    const std::string_view end = pattern.substr(at + placeholder.size());
    const bool fits = name.size() > begin.size() + end.size() && name.starts_with(begin) && name.ends_with(end);
    return fits ? name.substr(begin.size(), name.size() - begin.size() - end.size()) : std::string_view();
}

std::string_view without_unit(std::string_view column, std::string_view unit) {
    using Suffix = std::pair<std::string_view, std::string_view>;
    constexpr std::array kSuffixes{Suffix{"s", "_s"},         Suffix{"m", "_m"},     Suffix{"%", "_percent"},
                                   Suffix{"veh/h", "_veh_h"}, Suffix{"veh h", "_h"}, Suffix{"m/s", "_mps"},
                                   Suffix{"veh", "_veh"}};
    for (const auto& [of_unit, suffix] : kSuffixes) {
        if (unit == of_unit && column.ends_with(suffix)) return column.substr(0, column.size() - suffix.size());
    }
    return column;
}

std::string first_statement(std::string_view text) {
    return with_key(text.substr(0, std::min(text.find("; "), text.find(". "))), "`", "");
}

}  // namespace stopline

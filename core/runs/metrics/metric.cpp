#include "runs/metrics/metric.h"

#include <cmath>

#include <fmt/format.h>

#include "base/io/csv.h"

namespace stopline {

std::string MetricValue::csv_cell(int decimals) const {
    if (const auto* const text = std::get_if<std::string>(&value_)) return *text;
    if (const auto* const count = std::get_if<std::int64_t>(&value_)) return std::to_string(*count);
    return fixed(std::get<double>(value_), decimals);
}

std::string MetricValue::console_cell(int decimals, bool has_sign) const {
    const auto* const number = std::get_if<double>(&value_);
    if (number == nullptr) return csv_cell(decimals);
    if (std::isnan(*number)) return "-";
    return has_sign ? fmt::format("{:+.{}f}", *number, decimals) : fmt::format("{:.{}f}", *number, decimals);
}

std::vector<std::string> MetricFamily::key_names(const Scenario* scenario) const {
    if (keys != nullptr && scenario != nullptr) return keys(*scenario);
    if (described.empty()) return {std::string(placeholder)};
    std::vector<std::string> names;
    for (const MetricKey& key : described) names.emplace_back(key.name);
    return names;
}

}  // namespace stopline

#include "sumo_import/sumo_flow.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "base/random.h"
#include "base/text_hash.h"

namespace stopline {

namespace {

constexpr double kMaxVehicles = 2e7;

// Converts a time (seconds, hh:mm:ss or d:hh:mm:ss) to seconds. Returns nothing if the text is not a time.
std::optional<double> parse_time_s(std::string_view text) {
    if (text.find(':') == std::string_view::npos) return sumo_number(text);
    double sum_s = 0.0;
    double factor_s = 1.0;
    for (std::size_t parts = 1; parts <= 4; ++parts) {
        const std::size_t colon = text.rfind(':');
        const bool last = colon == std::string_view::npos;
        const auto part = sumo_number(last ? text : text.substr(colon + 1));
        if (!part || *part < 0.0) return std::nullopt;
        sum_s += factor_s * *part;
        factor_s *= parts < 3 ? 60.0 : 24.0;
        if (last) return parts >= 3 ? std::optional(sum_s) : std::nullopt;
        text = text.substr(0, colon);
    }
    return std::nullopt;
}

class Flow {
public:
    Flow(const SumoXml& xml, pugi::xml_node node, double until_s, std::uint64_t seed)
        : xml_(xml),
          node_(node),
          seed_(seed),
          key_(hash_of(xml.text(node, "id"))),
          begin_s_(sumo_time_s(xml, node, "begin", 0.0)),
          end_s_(sumo_time_s(xml, node, "end", until_s)) {
        if (end_s_ < begin_s_) xml.refuse(node, "the flow ends before it begins: 'end' must not be below 'begin'");
        until_s_ = std::min(end_s_, until_s);
        number_ = xml.optional_number(node, "number");
        if (number_ && (*number_ < 0.0 || *number_ != std::floor(*number_))) {
            xml.refuse(node, "'number' must be a whole number of at least 0");
        }
    }

    std::vector<double> departures() {
        const std::string_view period = node_.attribute("period").value();
        if (node_.attribute("probability")) {
            add_by_probability();
        } else if (period.starts_with("exp(") && period.ends_with(")")) {
            add_with_exponential_headways(sumo_number(period.substr(4, period.size() - 5)));
        } else {
            add_evenly();
        }
        return std::move(times_s_);
    }

private:
    double random_number(double index) const {
        return random_uniform(seed_, key_, static_cast<std::uint64_t>(index), Purpose::vehicle_type);
    }

    // Adds a departure. If the flow or the run ends at or before this time, or if the flow already has all its
    // vehicles, adds nothing and returns false.
    bool add(double time_s) {
        const auto count = static_cast<double>(times_s_.size());
        if (time_s >= until_s_ || (number_ && count >= *number_)) return false;
        if (count >= kMaxVehicles) {
            xml_.refuse(node_, fmt::format("the flow has more than {} vehicles", kMaxVehicles));
        }
        times_s_.push_back(time_s);
        return true;
    }

    void add_by_probability() {
        const double probability = xml_.number(node_, "probability");
        if (probability < 0.0 || probability > 1.0) xml_.refuse(node_, "'probability' must be between 0 and 1");
        for (std::int64_t second = 0; begin_s_ + static_cast<double>(second) < until_s_; ++second) {
            const double time_s = begin_s_ + static_cast<double>(second);
            if (random_number(time_s) < probability && !add(time_s)) return;
        }
    }

    void add_with_exponential_headways(const std::optional<double>& rate_1ps) {
        constexpr double kMaxRate_1ps = 1000.0;
        if (!rate_1ps || !(*rate_1ps > 0.0) || *rate_1ps > kMaxRate_1ps) {
            xml_.refuse(node_, fmt::format("period=\"exp(RATE)\": RATE must be more than 0 and at most {} a second",
                                           kMaxRate_1ps));
        }
        double time_s = begin_s_;
        for (std::int64_t k = 0;; ++k) {
            time_s -= std::log1p(-random_number(static_cast<double>(k))) / *rate_1ps;
            if (!add(time_s)) return;
        }
    }

    void add_evenly() {
        const double headway_s = even_headway_s();
        for (std::int64_t k = 0; add(begin_s_ + static_cast<double>(k) * headway_s);) ++k;
    }

    // Returns the end of a message about a missing attribute: the attribute that may be a misspelt one; "" for none.
    std::string misspelt_attribute_hint() const {
        const std::vector<std::string> known{"number", "period", "vehsPerHour", "perHour", "probability"};
        for (const pugi::xml_attribute attribute : node_.attributes()) {
            const std::string nearest = nearest_name(attribute.name(), known);
            if (nearest.empty()) continue;
            return fmt::format("; did you mean '{}' instead of '{}'?", nearest, shortened(attribute.name()));
        }
        return "";
    }

    // Returns the constant headway between the departures of a flow without random departures.
    double even_headway_s() const {
        constexpr double kMinHeadway_s = 1e-3;
        constexpr double kNever_s = 1e12;
        const char* const hourly = node_.attribute("perHour") ? "perHour" : "vehsPerHour";
        double headway_s = 0.0;
        if (const auto period = xml_.optional_number(node_, "period")) {
            headway_s = *period;
        } else if (const auto vehicles_per_hour = xml_.optional_number(node_, hourly)) {
            if (!(*vehicles_per_hour > 0.0)) {
                xml_.refuse(node_,
                            fmt::format("{}=\"{}\" must be more than 0", hourly, node_.attribute(hourly).value()));
            }
            headway_s = 3600.0 / *vehicles_per_hour;
        } else if (number_) {
            headway_s = *number_ > 0.0 ? (end_s_ - begin_s_) / *number_ : kNever_s;
        } else {
            xml_.refuse(node_,
                        "a flow needs 'number', 'period', 'vehsPerHour' or 'probability'" + misspelt_attribute_hint());
        }
        if (!(headway_s >= kMinHeadway_s)) {
            xml_.refuse(node_, fmt::format("the headway of the flow must be at least {} s", kMinHeadway_s));
        }
        return headway_s;
    }

    const SumoXml& xml_;
    pugi::xml_node node_;
    std::uint64_t seed_;
    std::uint64_t key_;
    double begin_s_ = 0.0;
    double end_s_ = 0.0;
    double until_s_ = 0.0;
    std::optional<double> number_;
    std::vector<double> times_s_;
};

}  // namespace

double sumo_time_s(const SumoXml& xml, pugi::xml_node node, const char* attribute, double fallback_s) {
    const pugi::xml_attribute found = node.attribute(attribute);
    if (!found) return fallback_s;
    const std::optional<double> value_s = parse_time_s(found.value());
    if (!value_s || *value_s < 0.0) {
        xml.refuse(node, fmt::format("{}=\"{}\" must be a time of at least 0: seconds, hh:mm:ss or d:hh:mm:ss",
                                     attribute, found.value()));
    }
    return *value_s;
}

std::vector<double> sumo_departures(const SumoXml& xml, pugi::xml_node flow, double until_s, std::uint64_t seed) {
    return Flow(xml, flow, until_s, seed).departures();
}

}  // namespace stopline

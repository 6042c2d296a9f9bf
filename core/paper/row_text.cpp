#include "paper/row_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/io/csv.h"

namespace stopline {

std::string main_section(const std::string& section) { return section.substr(0, section.find_first_of(". ")); }

std::string section_title(const std::string& main) {
    constexpr std::array<std::pair<const char*, const char*>, 6> kTitles{{{"I", "numbers of the introduction"},
                                                                          {"III", "one signal"},
                                                                          {"IV", "one intersection"},
                                                                          {"V", "calibration of the mesoscale mode"},
                                                                          {"VI", "arterial and grid"},
                                                                          {"VII", "Berlin"}}};
    for (const auto& [name, title] : kTitles) {
        if (main == name) return fmt::format("Section {}: {}", main, title);
    }
    if (main == "coordination") return "Beyond the paper: coordination between vehicles";
    if (main == "energy") return "Beyond the paper: energy and delay";
    return "Section " + main;
}

std::vector<std::string> main_sections(const std::vector<ScoredRow>& rows) {
    std::vector<std::string> sections;
    for (const ScoredRow& row : rows) {
        const std::string section = main_section(row.target.section);
        if (std::find(sections.begin(), sections.end(), section) == sections.end()) sections.push_back(section);
    }
    std::stable_partition(sections.begin(), sections.end(), [](const std::string& section) { return section == "I"; });
    return sections;
}

std::vector<std::string> paper_sections(const std::vector<ScoredRow>& rows) {
    std::vector<ScoredRow> of_paper = rows;
    std::erase_if(of_paper, [](const ScoredRow& row) { return row.target.kind == "own"; });
    return main_sections(of_paper);
}

std::string quantity_text(const ScoredRow& row) {
    std::string quantity = row.target.quantity;
    std::replace(quantity.begin(), quantity.end(), '_', ' ');
    constexpr std::array<std::pair<const char*, const char*>, 2> kNames{{{"ctg ref", "CTG-Ref"}, {"50kmh", "50 km/h"}}};
    for (const auto& [written, name] : kNames) {
        const std::size_t found = quantity.find(written);
        if (found != std::string::npos) quantity.replace(found, std::char_traits<char>::length(written), name);
    }
    return quantity;
}

std::string difference_text(const ScoredRow& row) {
    const std::optional<double> paper = parse_number(row.target.value);
    const std::optional<double> ours = parse_number(row.ours);
    if (!paper || !ours) return "";
    const double difference = *ours - *paper;
    if (std::abs(difference) < 1e-9) return "0";
    std::string text = fmt::format("{:+.4g}", difference);
    if (row.target.unit != "%" && *paper != 0.0) text += fmt::format(" ({:+.1f} %)", 100.0 * difference / *paper);
    return text;
}

}  // namespace stopline

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/catalogue.h"
#include "fuzz/mutators.h"

namespace stopline::fuzz {

namespace {

using Lines = std::vector<std::string>;

Lines lines_of(std::string_view text) {
    Lines lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        lines.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (lines.empty()) lines.emplace_back();
    return lines;
}

std::string joined(const Lines& lines) {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
}

std::size_t indentation(const std::string& line) { return std::min(line.find_first_not_of(' '), line.size()); }

// Replaces the value after the last "key: " of the line, up to the next comma or bracket.
void replace_value(std::string& line, Random& random) {
    std::vector<std::size_t> values;
    for (std::size_t k = line.find(": "); k != std::string::npos; k = line.find(": ", k + 1)) values.push_back(k + 2);
    if (values.empty()) {
        line += ": " + random.one_of(catalogue().values);
        return;
    }
    const std::size_t begin = random.one_of(values);
    const std::size_t end = std::min(line.find_first_of(",]}", begin), line.size());
    line.replace(begin, end - begin, random.one_of(catalogue().values));
}

// Replaces the first key of the line.
void replace_key(std::string& line, Random& random) {
    const std::size_t begin = std::min(line.find_first_not_of(" -{"), line.size());
    const std::size_t end = std::min(line.find(':', begin), line.size());
    line.replace(begin, end - begin, random.one_of(catalogue().keys));
}

void insert_line(Lines& lines, std::size_t position, Random& random) {
    std::string line(indentation(lines[position]) + 2 * random.below(2), ' ');
    if (random.below(4) == 0) line += "- ";
    line += random.one_of(catalogue().keys) + ":";
    if (random.below(4) != 0) line += " " + random.one_of(catalogue().values);
    lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(position) + 1, line);
}

void change_line(Lines& lines, Random& random) {
    const std::size_t k = random.below(lines.size());
    const auto line = lines.begin() + static_cast<std::ptrdiff_t>(k);
    switch (random.below(8)) {
        case 0:
            return replace_key(*line, random);
        case 1:
            return insert_line(lines, k, random);
        case 2:
            if (lines.size() > 1) lines.erase(line);
            return;
        case 3: {
            const std::string copy = *line;
            lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(random.below(lines.size() + 1)), copy);
            return;
        }
        case 4:
            return std::swap(*line, lines[random.below(lines.size())]);
        case 5:
            if (random.below(2) == 0)
                line->insert(0, "  ");
            else if (line->starts_with("  "))
                line->erase(0, 2);
            return;
        default:
            return replace_value(*line, random);
    }
}

}  // namespace

void mutate_yaml(std::string& text, Random& random, ByteMutator /*mutate_bytes*/) {
    Lines lines = lines_of(text);
    for (std::size_t changes = 1 + random.below(3); changes > 0; --changes) change_line(lines, random);
    text = joined(lines);
}

void mutate_overrides(std::string& text, Random& random, ByteMutator /*mutate_bytes*/) {
    Lines lines = lines_of(text);
    std::string& line = lines[random.below(lines.size())];
    const std::size_t equals = std::min(line.find('='), line.size());
    switch (random.below(4)) {
        case 0:
            line.replace(0, equals, random.one_of(catalogue().paths));
            break;
        case 1:
            line = line.substr(0, equals) + "=" + random.one_of(catalogue().values);
            break;
        case 2:
            lines.push_back(random.one_of(catalogue().paths) + "=" + random.one_of(catalogue().values));
            break;
        default:
            if (lines.size() > 1) lines.pop_back();
            break;
    }
    text = joined(lines);
}

}  // namespace stopline::fuzz

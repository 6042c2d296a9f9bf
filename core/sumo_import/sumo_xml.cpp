#include "sumo_import/sumo_xml.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/input_error.h"
#include "base/nearest_name.h"
#include "base/text_hash.h"
#include "sumo_import/xml/xml_text.h"

namespace stopline {

namespace {

// The hash of a text, and the position of the first control character that XML does not allow.
struct TextScan {
    std::uint64_t hash = kEmptyTextHash;
    std::size_t control_character = std::string::npos;
};

bool is_forbidden(char c) { return static_cast<unsigned char>(c) < ' ' && c != '\n' && c != '\r' && c != '\t'; }

TextScan scan(std::string_view text) {
    TextScan result;
    bool is_found = false;
    for (std::size_t k = 0; k < text.size(); ++k) {
        result.hash = extended_hash(result.hash, text[k]);
        if (!is_forbidden(text[k]) || is_found) continue;
        result.control_character = k;
        is_found = true;
    }
    return result;
}

// The byte range of a comment, a CDATA section or a processing instruction in the text of a file.
struct Section {
    std::size_t begin = 0;
    std::size_t end = 0;
};

// Returns the next section at or after the position `from`, or an empty section at the end of the text.
Section next_section(std::string_view text, std::size_t from) {
    constexpr std::array<std::array<std::string_view, 2>, 3> kKinds{
        {{"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<?", "?>"}}};
    for (std::size_t k = text.find('<', from); k != std::string_view::npos; k = text.find('<', k + 1)) {
        for (const auto& [opening, closing] : kKinds) {
            if (text.substr(k, opening.size()) != opening) continue;
            const std::size_t end = text.find(closing, k + opening.size());
            return {k, end == std::string_view::npos ? text.size() : end + closing.size()};
        }
    }
    return {text.size(), text.size()};
}

// Returns true if `text`, which follows a '&', begins with one of the five entities of XML or with the number of a
// character that XML allows.
bool is_entity(std::string_view text) {
    constexpr std::array<std::string_view, 5> kNamed{"amp;", "lt;", "gt;", "quot;", "apos;"};
    if (std::any_of(kNamed.begin(), kNamed.end(), [&](std::string_view name) { return text.starts_with(name); })) {
        return true;
    }
    if (!text.starts_with('#')) return false;
    const bool hexadecimal = text.substr(1).starts_with('x');
    text.remove_prefix(hexadecimal ? 2 : 1);
    constexpr unsigned kLastCharacter = 0x10FFFF;
    unsigned number = 0;
    const char* const begin = text.data();
    const auto [end, error] = std::from_chars(begin, begin + text.size(), number, hexadecimal ? 16 : 10);
    if (error != std::errc() || end == begin + text.size() || *end != ';') return false;
    const bool is_surrogate = number >= 0xD800 && number <= 0xDFFF;
    return number <= kLastCharacter && !is_surrogate && (number >= ' ' || !is_forbidden(static_cast<char>(number)));
}

// Returns the position of the first '&' that begins an unknown entity. pugixml does not report unknown entities.
std::optional<std::size_t> unknown_entity(std::string_view text) {
    constexpr std::size_t kMaxEntityLength = 12;
    Section section;
    for (std::size_t k = text.find('&'); k != std::string_view::npos; k = text.find('&', k + 1)) {
        if (is_entity(text.substr(k + 1, kMaxEntityLength))) continue;
        while (section.end <= k) section = next_section(text, section.end);
        if (section.begin > k) return k;
        k = section.end - 1;
    }
    return std::nullopt;
}

// Returns the element name in the last tag that begins before the position.
std::string_view element_before(std::string_view text, std::size_t position) {
    const std::size_t begin = text.rfind('<', position);
    if (begin == std::string_view::npos) return "";
    return text.substr(begin + 1, std::min(text.find_first_of(" \t\r\n/>", begin + 1), position) - begin - 1);
}

// Returns the version in a word such as "1.28.0" or "v1_8_0+2135", or nothing if the word is no version.
std::optional<SumoVersion> version_of(std::string_view word) {
    if (word.starts_with('v')) word.remove_prefix(1);
    SumoVersion version;
    const char* const begin = word.data();
    const char* const end = begin + word.size();
    const auto [dot, major_error] = std::from_chars(begin, end, version.major);
    if (major_error != std::errc() || dot == end || (*dot != '.' && *dot != '_')) return std::nullopt;
    const auto [rest, minor_error] = std::from_chars(dot + 1, end, version.minor);
    if (minor_error != std::errc()) return std::nullopt;
    return version;
}

}  // namespace

std::optional<double> sumo_number(std::string_view text) {
    double value = 0.0;
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::string known_ids_hint(std::string_view unknown, std::vector<std::string> ids) {
    constexpr std::size_t kListedMax = 12;
    std::sort(ids.begin(), ids.end());
    return known_names_hint(unknown, ids, kListedMax);
}

std::vector<std::string_view> sumo_words(std::string_view text) {
    constexpr std::string_view kBlanks = " \t\r\n";
    std::vector<std::string_view> words;
    for (std::size_t k = text.find_first_not_of(kBlanks); k != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(kBlanks, k), text.size());
        words.push_back(text.substr(k, end - k));
        k = text.find_first_not_of(kBlanks, end);
    }
    return words;
}

std::string text_of(const SumoVersion& version) { return fmt::format("{}.{}", version.major, version.minor); }

// In the comment at the start of a file, releases of SUMO write "SUMO netconvert 1.28.0" or "SUMO netconvert Version
// 1.4.0". Other builds of SUMO write "SUMO netconvert Version v1_8_0+2135-a1b2".
std::optional<SumoVersion> sumo_version(std::string_view text) {
    constexpr std::string_view kProgram = "SUMO ";
    for (std::size_t k = text.find('<'); k != std::string_view::npos;) {
        const bool is_comment = text.substr(k).starts_with("<!--");
        if (!is_comment && !text.substr(k).starts_with("<?")) return std::nullopt;
        const std::size_t end = std::min(text.find(is_comment ? "-->" : "?>", k), text.size());
        const std::string_view line = text.substr(k, std::min(text.find('\n', k), end) - k);
        k = text.find('<', end);
        const std::size_t program = line.find(kProgram);
        if (!is_comment || program == std::string_view::npos) continue;
        const std::vector<std::string_view> words = sumo_words(line.substr(program + kProgram.size()));
        for (std::size_t word = 1; word < words.size(); ++word) {
            if (const std::optional<SumoVersion> version = version_of(words[word])) return version;
        }
    }
    return std::nullopt;
}

SumoXml::SumoXml(const std::filesystem::path& file, std::initializer_list<std::string_view> root_names)
    : name_(file.lexically_normal().generic_string()),
      text_(read_xml_text(file, name_)),
      version_(sumo_version(text_)) {
    for (const char* at = text_.data(); at != nullptr;) {
        at =
            static_cast<const char*>(std::memchr(at, '\n', static_cast<std::size_t>(text_.data() + text_.size() - at)));
        if (at == nullptr) break;
        line_ends_.push_back(static_cast<std::uint32_t>(at - text_.data()));
        ++at;
    }
    const TextScan scanned = scan(text_);
    hash_ = scanned.hash;
    if (const std::size_t position = scanned.control_character; position != std::string::npos) {
        throw InputError(fmt::format("{}:{}: the file is not XML text: it has the control character 0x{:02X}", name_,
                                     line_of(static_cast<std::ptrdiff_t>(position)), int{text_[position]}));
    }
    parse();
    const auto is_root = [&](std::string_view name) { return name == root_.name(); };
    if (std::none_of(root_names.begin(), root_names.end(), is_root)) {
        refuse(root_, fmt::format("the root element is '{}'; it must be '{}'", shortened(root_.name()),
                                  fmt::join(root_names, "' or '")));
    }
}

void SumoXml::parse() {
    std::string entity_problem;
    if (const std::optional<std::size_t> position = unknown_entity(text_)) {
        const std::string_view rest = std::string_view(text_).substr(*position);
        entity_problem = fmt::format(
            "{}:{}: element '{}': '{}' is not an XML entity; known are &amp; &lt; &gt; &quot; &apos; and "
            "the numbers of characters, such as &#65;, except control characters",
            name_, line_of(static_cast<std::ptrdiff_t>(*position)), shortened(element_before(text_, *position)),
            shortened(rest.substr(0, rest.find_first_of(" \t\r\n\"';<>", 1))));
    }
    document_ = std::make_unique<pugi::xml_document>();
    const std::string_view beginning = std::string_view(text_).substr(0, 1 << 16);
    if (beginning.find_first_not_of(" \t\r\n") == std::string_view::npos && text_.size() < beginning.size() + 1) {
        throw InputError(name_ + ":1: the file is empty");
    }
    const unsigned options = pugi::parse_default | pugi::parse_doctype;
    const pugi::xml_parse_result result =
        document_->load_buffer_inplace(text_.data(), text_.size(), options, pugi::encoding_utf8);
    if (!result) {
        throw InputError(fmt::format("{}:{}: the file is not well-formed XML: {}", name_, line_of(result.offset),
                                     result.description()));
    }
    for (const pugi::xml_node node : document_->children()) {
        if (node.type() == pugi::node_doctype) {
            refuse(node, "the file has a DOCTYPE; document type declarations are not supported");
        }
        if (node.type() != pugi::node_element) continue;
        if (root_) refuse(node, "the file has a second root element; one is allowed");
        root_ = node;
    }
    if (!root_) throw InputError(name_ + ":1: the file has no XML element");
    if (!entity_problem.empty()) throw InputError(entity_problem);
    check_elements();
}

// Throws InputError if an element is nested too deeply or has an invalid list of attributes.
void SumoXml::check_elements() const {
    std::vector<std::string_view> names;
    int depth = 1;
    for (pugi::xml_node node = root_; node;) {
        check_attributes(node, names);
        pugi::xml_node next = node.first_child();
        if (next && ++depth > kXmlDepthMax) {
            refuse(next, fmt::format("the elements are nested more than {} levels deep", kXmlDepthMax));
        }
        while (!next && node != root_) {
            next = node.next_sibling();
            if (next) break;
            node = node.parent();
            --depth;
        }
        node = next;
    }
}

// Throws InputError if an element has too many attributes, two with the same name, or an id with a line break or a tab.
// pugixml accepts such an element. `names` is memory that the calls share.
void SumoXml::check_attributes(pugi::xml_node node, std::vector<std::string_view>& names) const {
    names.clear();
    for (const pugi::xml_attribute attribute : node.attributes()) {
        names.emplace_back(attribute.name());
        const bool is_id = names.back() == "id";
        if (is_id && std::string_view(attribute.value()).find_first_of("\n\r\t") != std::string_view::npos) {
            refuse(node, fmt::format("element '{}': the id has a line break or a tab", node.name()));
        }
    }
    if (names.size() > kXmlAttributesMax) {
        refuse(node, fmt::format("element '{}' has {} attributes; at most {} are allowed", shortened(node.name()),
                                 names.size(), kXmlAttributesMax));
    }
    std::sort(names.begin(), names.end());
    if (const auto duplicate = std::adjacent_find(names.begin(), names.end()); duplicate != names.end()) {
        refuse(node, fmt::format("element '{}': attribute '{}' is given twice; once is allowed", node.name(),
                                 shortened(*duplicate)));
    }
}

std::size_t SumoXml::line_of(std::ptrdiff_t offset) const {
    const auto at = static_cast<std::uint32_t>(std::max<std::ptrdiff_t>(offset, 0));
    return static_cast<std::size_t>(std::lower_bound(line_ends_.begin(), line_ends_.end(), at) - line_ends_.begin()) +
           1;
}

std::string SumoXml::where(pugi::xml_node node) const {
    return fmt::format("{}:{}", name_, line_of(node.offset_debug()));
}

void SumoXml::refuse(pugi::xml_node node, const std::string& message) const {
    throw InputError(where(node) + ": " + message);
}

std::string SumoXml::text(pugi::xml_node node, const char* attribute) const {
    const pugi::xml_attribute found = node.attribute(attribute);
    if (!found || *found.value() == '\0') {
        refuse(node, fmt::format("element '{}' has no attribute '{}'", node.name(), attribute));
    }
    return found.value();
}

std::optional<double> SumoXml::optional_number(pugi::xml_node node, const char* attribute) const {
    const pugi::xml_attribute found = node.attribute(attribute);
    if (!found) return std::nullopt;
    const std::optional<double> value = sumo_number(found.value());
    if (!value) {
        refuse(node, fmt::format("element '{}': {}=\"{}\" is not a finite number", node.name(), attribute,
                                 shortened(found.value())));
    }
    return value;
}

double SumoXml::number(pugi::xml_node node, const char* attribute) const {
    text(node, attribute);
    return *optional_number(node, attribute);
}

double SumoXml::number_or(pugi::xml_node node, const char* attribute, double fallback) const {
    return optional_number(node, attribute).value_or(fallback);
}

int SumoXml::whole_number(pugi::xml_node node, const char* attribute) const {
    constexpr double kMax = 1e9;
    const double value = number(node, attribute);
    if (value != std::floor(value) || value < 0.0 || value > kMax) {
        refuse(node, fmt::format("element '{}': {}=\"{}\" must be a whole number from 0 to {}", node.name(), attribute,
                                 shortened(node.attribute(attribute).value()), kMax));
    }
    return static_cast<int>(value);
}

}  // namespace stopline

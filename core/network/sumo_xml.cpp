#include "network/sumo_xml.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <unistd.h>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include "base/input_error.h"

namespace stopline {

namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 31;

// The line is that of the text as far as it could be unpacked.
[[noreturn]] void damaged(const std::string& name, const std::string& unpacked) {
    throw InputError(fmt::format("{}:{}: is damaged or cut off here (gzip)", name,
                                 std::count(unpacked.begin(), unpacked.end(), '\n') + 1));
}

// zlib reads plain files too.
std::string read_text(const std::filesystem::path& file, const std::string& name) {
    if (const std::string problem = sumo_file_problem(file); !problem.empty()) throw InputError(name + ": " + problem);
    struct Close {
        void operator()(gzFile_s* opened) const { gzclose(opened); }
    };
    const std::unique_ptr<gzFile_s, Close> in(gzopen(file.c_str(), "rb"));
    if (!in) throw InputError(name + ": cannot be opened");
    constexpr unsigned kBuffer = 1U << 20;
    gzbuffer(in.get(), kBuffer);
    std::string text;
    text.reserve(static_cast<std::size_t>(std::min<std::uintmax_t>(std::filesystem::file_size(file), kMostBytes)) + 1);
    std::vector<char> chunk(kBuffer);
    for (;;) {
        const int count = gzread(in.get(), chunk.data(), kBuffer);
        if (count < 0) damaged(name, text);
        if (count == 0) break;
        text.append(chunk.data(), static_cast<std::size_t>(count));
        if (text.size() >= kMostBytes) throw InputError(name + ": is larger than 2 GiB");
    }
    int state = Z_OK;
    gzerror(in.get(), &state);
    if (state != Z_OK && state != Z_STREAM_END) damaged(name, text);
    return text;
}

std::uint64_t hash_of(const std::string& text) {
    std::uint64_t hash = 0xcbf29ce484222325U;
    for (const char c : text) {
        hash ^= static_cast<unsigned char>(c);
        hash *= 0x100000001b3U;
    }
    return hash;
}

// A comment, a CDATA section or a processing instruction.
struct Section {
    std::size_t begin = 0;
    std::size_t end = 0;
};

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

// What follows a '&'.
bool is_entity(std::string_view text) {
    constexpr std::array<std::string_view, 5> kNamed{"amp;", "lt;", "gt;", "quot;", "apos;"};
    if (std::any_of(kNamed.begin(), kNamed.end(), [&](std::string_view name) { return text.starts_with(name); })) {
        return true;
    }
    if (!text.starts_with('#')) return false;
    const bool hexadecimal = text.substr(1).starts_with('x');
    text.remove_prefix(hexadecimal ? 2 : 1);
    const std::size_t end = text.find_first_not_of(hexadecimal ? "0123456789abcdefABCDEF" : "0123456789");
    return end != 0 && end != std::string_view::npos && text[end] == ';';
}

// Of the first '&' that begins nothing that XML knows. pugixml leaves those as they are.
std::optional<std::size_t> unknown_entity(std::string_view text) {
    constexpr std::size_t kLongest = 12;
    Section section;
    for (std::size_t k = text.find('&'); k != std::string_view::npos; k = text.find('&', k + 1)) {
        if (is_entity(text.substr(k + 1, kLongest))) continue;
        while (section.end <= k) section = next_section(text, section.end);
        if (section.begin > k) return k;
        k = section.end - 1;
    }
    return std::nullopt;
}

// The element in whose tag or behind whose tag a place lies.
std::string_view element_at(std::string_view text, std::size_t place) {
    const std::size_t begin = text.rfind('<', place);
    if (begin == std::string_view::npos) return "";
    return text.substr(begin + 1, std::min(text.find_first_of(" \t\r\n/>", begin + 1), place) - begin - 1);
}

std::string shortened(std::string_view text) {
    constexpr std::size_t kMost = 60;
    return text.size() <= kMost ? std::string(text) : std::string(text.substr(0, kMost)) + "...";
}

}  // namespace

std::string sumo_file_problem(const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found) return "there is no such file";
    if (std::filesystem::is_directory(status)) return "is a folder, not a file";
    if (!std::filesystem::is_regular_file(status)) return "is not a file that can be read to an end (a device, a pipe)";
    return ::access(file.c_str(), R_OK) == 0 ? "" : "cannot be opened (no permission?)";
}

std::optional<double> sumo_number(std::string_view text) {
    double value = 0.0;
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
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

SumoXml::SumoXml(const std::filesystem::path& file, std::initializer_list<std::string_view> roots)
    : name_(file.lexically_normal().generic_string()), text_(read_text(file, name_)), hash_(hash_of(text_)) {
    for (const char* at = text_.data(); at != nullptr;) {
        at =
            static_cast<const char*>(std::memchr(at, '\n', static_cast<std::size_t>(text_.data() + text_.size() - at)));
        if (at == nullptr) break;
        breaks_.push_back(static_cast<std::uint32_t>(at - text_.data()));
        ++at;
    }
    parse();
    const auto known = [&](std::string_view root) { return root == root_.name(); };
    if (std::none_of(roots.begin(), roots.end(), known)) {
        refuse(root_,
               fmt::format("the outermost element is '{}', not {}", shortened(root_.name()), fmt::join(roots, " or ")));
    }
}

void SumoXml::parse() {
    std::string entity;  // that is not known
    if (const std::optional<std::size_t> place = unknown_entity(text_)) {
        const std::string_view rest = std::string_view(text_).substr(*place);
        entity =
            fmt::format("{}:{}: element '{}': '{}' is no entity: known are &amp; &lt; &gt; &quot; &apos; and numbers",
                        name_, line_of(static_cast<std::ptrdiff_t>(*place)), shortened(element_at(text_, *place)),
                        shortened(rest.substr(0, rest.find_first_of(" \t\r\n\"';<>", 1))));
    }
    document_ = std::make_unique<pugi::xml_document>();
    const std::string_view blank = std::string_view(text_).substr(0, 1 << 16);
    if (blank.find_first_not_of(" \t\r\n") == std::string_view::npos && text_.size() < blank.size() + 1) {
        throw InputError(name_ + ":1: the file is empty");
    }
    const unsigned options = pugi::parse_default | pugi::parse_doctype;
    const pugi::xml_parse_result result =
        document_->load_buffer_inplace(text_.data(), text_.size(), options, pugi::encoding_utf8);
    if (!result) {
        throw InputError(
            fmt::format("{}:{}: is not well-formed XML: {}", name_, line_of(result.offset), result.description()));
    }
    for (const pugi::xml_node node : document_->children()) {
        if (node.type() == pugi::node_doctype) {
            refuse(node, "has a DOCTYPE; documents that declare types or entities are not read");
        }
        if (node.type() != pugi::node_element) continue;
        if (root_) refuse(node, "there is a second outermost element");
        root_ = node;
    }
    if (!root_) throw InputError(name_ + ":1: there is no element in it");
    if (!entity.empty()) throw InputError(entity);
    refuse_doubles();
}

// pugixml keeps all attributes of a name, and finds the first.
void SumoXml::refuse_doubles() const {
    std::vector<std::string_view> names;
    for (pugi::xml_node node = root_; node;) {
        names.clear();
        for (const pugi::xml_attribute attribute : node.attributes()) names.emplace_back(attribute.name());
        std::sort(names.begin(), names.end());
        if (const auto twice = std::adjacent_find(names.begin(), names.end()); twice != names.end()) {
            refuse(node, fmt::format("element '{}': attribute '{}' is given twice; once is allowed", node.name(),
                                     shortened(*twice)));
        }
        pugi::xml_node next = node.first_child();
        while (!next && node != root_) {
            next = node.next_sibling();
            if (!next) node = node.parent();
        }
        node = next;
    }
}

std::size_t SumoXml::line_of(std::ptrdiff_t offset) const {
    const auto at = static_cast<std::uint32_t>(std::max<std::ptrdiff_t>(offset, 0));
    return static_cast<std::size_t>(std::lower_bound(breaks_.begin(), breaks_.end(), at) - breaks_.begin()) + 1;
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
        refuse(node, fmt::format("element '{}' has no '{}'", node.name(), attribute));
    }
    return found.value();
}

std::optional<double> SumoXml::number_if(pugi::xml_node node, const char* attribute) const {
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
    return *number_if(node, attribute);
}

double SumoXml::number_or(pugi::xml_node node, const char* attribute, double fallback) const {
    return number_if(node, attribute).value_or(fallback);
}

int SumoXml::whole(pugi::xml_node node, const char* attribute) const {
    constexpr double kMost = 1e9;
    const double value = number(node, attribute);
    if (value != std::floor(value) || value < 0.0 || value > kMost) {
        refuse(node, fmt::format("element '{}': {}=\"{}\" is not a whole number from 0 on", node.name(), attribute,
                                 shortened(node.attribute(attribute).value())));
    }
    return static_cast<int>(value);
}

}  // namespace stopline

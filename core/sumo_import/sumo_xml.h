// Strict reader for SUMO's XML files, plain or gzipped. For every problem it throws an InputError whose message begins
// with file and line.
//
// The reader rejects document type declarations, XML that is not well-formed, control characters, and numbers that are
// not finite. It also rejects duplicate attributes and unknown entities, which pugixml accepts. Limits on size and
// memory (xml/xml_text.h), nesting and attributes protect the program from hostile files.
#pragma once

#include <compare>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

namespace stopline {

inline constexpr int kXmlDepthMax = 100;
inline constexpr std::size_t kXmlAttributesMax = 1000;  // of one element

// A version of SUMO, such as 1.28. The third number is left out, because no third number changed the format.
struct SumoVersion {
    int major = 0;
    int minor = 0;
    auto operator<=>(const SumoVersion&) const = default;
};
std::string text_of(const SumoVersion& version);

class SumoXml {
public:
    // Reads and parses the file. Throws InputError unless the name of the root element is in `root_names`.
    SumoXml(const std::filesystem::path& file, std::initializer_list<std::string_view> root_names);

    pugi::xml_node root() const { return root_; }
    // Returns file and line of the node, such as "scenarios/city.net.xml:12".
    std::string where(pugi::xml_node node) const;
    const std::string& name() const { return name_; }
    std::size_t bytes() const { return text_.size(); }
    // Returns the 64-bit FNV-1a hash of the unpacked text.
    std::uint64_t hash() const { return hash_; }

    // Returns the version of SUMO in the comment that SUMO's programs write before the root element, such as "generated
    // on 2026-01-31 by Eclipse SUMO netconvert 1.28.0". Returns nothing if there is no such comment.
    std::optional<SumoVersion> version() const { return version_; }

    // Throws InputError with the message, preceded by file and line of the node.
    [[noreturn]] void refuse(pugi::xml_node node, const std::string& message) const;

    // The next functions return the value of an attribute. They throw InputError if the value is malformed. If the
    // attribute is missing, text(), number() and whole_number() also throw InputError.
    std::string text(pugi::xml_node node, const char* attribute) const;
    std::optional<double> optional_number(pugi::xml_node node, const char* attribute) const;
    double number(pugi::xml_node node, const char* attribute) const;
    double number_or(pugi::xml_node node, const char* attribute, double fallback) const;
    int whole_number(pugi::xml_node node, const char* attribute) const;

private:
    void parse();
    void check_elements() const;
    void check_attributes(pugi::xml_node node, std::vector<std::string_view>& names) const;
    std::size_t line_of(std::ptrdiff_t offset) const;

    std::string name_;
    std::string text_;                      // text of the file; pugixml parses it in place
    std::vector<std::uint32_t> line_ends_;  // byte offsets of the line breaks in text_
    std::uint64_t hash_ = 0;
    std::optional<SumoVersion> version_;
    std::unique_ptr<pugi::xml_document> document_;
    pugi::xml_node root_;
};

// Returns the version in the comments before the root element of a file with this text, as SumoXml::version() does.
std::optional<SumoVersion> sumo_version(std::string_view text);
// Converts the text to a number. Returns nothing unless the whole text is one finite decimal number.
std::optional<double> sumo_number(std::string_view text);
// Returns the end of a message about an unknown id: the most similar id, and some known ids in alphabetical order.
std::string known_ids_hint(std::string_view unknown, std::vector<std::string> ids);
// Returns the words of the text, which are separated by white space.
std::vector<std::string_view> sumo_words(std::string_view text);

}  // namespace stopline

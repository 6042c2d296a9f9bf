// XML as SUMO writes it, read strictly: whatever cannot be used is an InputError that begins with file and line.
//
// Plain or gzipped, told apart by the first bytes. Refused: document type declarations (and so entities of their own), files larger than
// 2 GiB when unpacked, anything that is not well-formed (pugixml minds neither attributes given twice nor unknown entities: they are
// looked for here), numbers that are not finite. pugixml tells byte offsets; lines are counted from them, in the text as it was read.
#pragma once

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

class SumoXml {
public:
    // Reads and parses; `root` is what the outermost element must be called, one of these. Throws InputError.
    SumoXml(const std::filesystem::path& file, std::initializer_list<std::string_view> roots);

    pugi::xml_node root() const { return root_; }
    // "scenarios/city.net.xml:12"
    std::string where(pugi::xml_node node) const;
    const std::string& name() const { return name_; }
    std::size_t bytes() const { return text_.size(); }
    // 64-bit FNV-1a hash of the unpacked text.
    std::uint64_t hash() const { return hash_; }

    [[noreturn]] void refuse(pugi::xml_node node, const std::string& message) const;

    // Attributes. The required ones are refused where they are missing.
    std::string text(pugi::xml_node node, const char* attribute) const;
    std::optional<double> number_if(pugi::xml_node node, const char* attribute) const;
    double number(pugi::xml_node node, const char* attribute) const;
    double number_or(pugi::xml_node node, const char* attribute, double fallback) const;
    int whole(pugi::xml_node node, const char* attribute) const;

private:
    void parse();
    void refuse_doubles() const;
    std::size_t line_of(std::ptrdiff_t offset) const;

    std::string name_;
    std::string text_;                   // parsed in place
    std::vector<std::uint32_t> breaks_;  // offsets of the ends of lines
    std::uint64_t hash_ = 0;
    std::unique_ptr<pugi::xml_document> document_;
    pugi::xml_node root_;
};

// Why a file cannot be opened and read to an end; empty: it can.
std::string sumo_file_problem(const std::filesystem::path& file);
// A finite decimal number and nothing else.
std::optional<double> sumo_number(std::string_view text);
// Words between blanks.
std::vector<std::string_view> sumo_words(std::string_view text);

}  // namespace stopline

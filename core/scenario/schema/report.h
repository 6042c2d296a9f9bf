// Collects the errors and warnings from loading a file, each with its position, so that a user sees all mistakes at
// once.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenario/yaml/source_node.h"

namespace stopline {

class Report {
public:
    void error(const Place& place, const std::string& message);
    std::size_t error_count() const { return errors_.size(); }
    // Throws an InputError if an error was reported. The text of the InputError has one line per error in file order,
    // for at most 20 errors.
    void throw_if_any() const;

    // A warning does not stop loading.
    void warn(const Place& place, const std::string& message);
    // Returns one line per warning in file order, without repetitions.
    std::vector<std::string> warnings() const;

    // Stores the path of a data file that was read.
    void add_file(const std::filesystem::path& file) { files_.push_back(file); }
    const std::vector<std::filesystem::path>& files() const { return files_; }

    // Stores the position of a field under its path, such as "populations[0].name".
    void remember(const std::string& path, const Place& place) { places_[path] = place; }
    // Returns true if the file gives the field at `path`.
    bool given(const std::string& path) const { return places_.contains(path); }
    // Returns the position of a field. For a field that the file does not give, returns the position of its parent.
    Place place_of(std::string path) const;

private:
    struct Entry {
        Place place;
        std::string message;
    };

    static std::vector<std::string> sorted_lines(std::vector<Entry> entries);

    std::vector<Entry> errors_;
    std::vector<Entry> warnings_;
    std::map<std::string, Place> places_;
    std::vector<std::filesystem::path> files_;
};

// Collects the errors from a check that compares several fields (Table::check). Paths are relative to the checked
// struct; "" is the struct itself.
class Checker {
public:
    Checker(Report& report, std::string path) : report_(report), path_(std::move(path)) {}
    void error(const std::string& relative_path, const std::string& message);
    bool given(const std::string& relative_path) const { return report_.given(full_path(relative_path)); }

private:
    std::string full_path(const std::string& relative_path) const;

    Report& report_;
    std::string path_;
};

// Returns "parent.name". Adds no dot if the parent or the name is empty, or if the name begins with '['.
std::string join_path(const std::string& parent, const std::string& name);

}  // namespace stopline

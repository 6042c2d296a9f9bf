// Collects errors, so that a user sees all mistakes of a file at once, each with its place.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenario/source_node.h"

namespace stopline {

class Report {
public:
    void error(const Place& place, const std::string& message);
    std::size_t count() const { return errors_.size(); }
    void throw_if_any() const;  // InputError: one line an error in the order of the file, the first twenty

    // Where the field at a path stands ("populations[0].name"); for a field that was not given, where its parent stands.
    void remember(const std::string& path, const Place& place) { places_[path] = place; }
    bool given(const std::string& path) const { return places_.contains(path); }
    Place place_of(std::string path) const;

private:
    struct Error {
        Place place;
        std::string message;
    };

    std::vector<Error> errors_;
    std::map<std::string, Place> places_;
};

// What a check of settings that depend on each other needs; paths are relative to those settings ("" : they themselves).
class Checker {
public:
    Checker(Report& report, std::string path) : report_(report), path_(std::move(path)) {}
    void error(const std::string& relative_path, const std::string& message);
    bool given(const std::string& relative_path) const { return report_.given(full(relative_path)); }

private:
    std::string full(const std::string& relative_path) const;

    Report& report_;
    std::string path_;
};

// "parent.name", or the one that is not empty.
std::string join_path(const std::string& parent, const std::string& name);

}  // namespace stopline

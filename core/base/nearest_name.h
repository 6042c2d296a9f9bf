// Helpers for error messages: suggestions for misspelt names, lists of names, and shortened values.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace stopline {

// Returns the candidate closest to `name` in edit distance, ignoring case. Returns "" if no candidate is similar
// enough.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

// Returns the end of a message about an unknown name: "; did you mean 'x'? Known: a, b, c". The text lists at most
// `max_listed` candidates and then says how many were left out, such as "and 7 more".
std::string known_names_hint(std::string_view name, const std::vector<std::string>& candidates,
                             std::size_t max_listed = std::string::npos);

// Joins the names to one text, with `between` between them.
std::string joined(const std::vector<std::string>& names, std::string_view between = ", ");

// Returns the text cut to 60 characters, with spaces in place of control characters. A cut text ends in "...".
std::string shortened(std::string_view text);

}  // namespace stopline

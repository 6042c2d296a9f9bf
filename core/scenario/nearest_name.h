// Helpers for messages: the name that was probably meant, lists of names, and values cut to a length that fits a line.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace stopline {

// The candidate closest to `name` in edit distance (case ignored), or "" if none is close enough to be meant.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

// "; did you mean 'x'? Known: a, b, c": the end of every message about an unknown name. Of more than `most` the first are listed: "a, b and 7 more".
std::string known_names(std::string_view name, const std::vector<std::string>& candidates,
                        std::size_t most = std::string::npos);

std::string joined(const std::vector<std::string>& names, std::string_view between = ", ");

// At most 60 characters, line breaks and the like replaced.
std::string shortened(std::string_view text);

}  // namespace stopline

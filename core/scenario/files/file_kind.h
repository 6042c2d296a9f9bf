// Recognises a file that was given in place of another one, such as a sweep in place of a scenario.
#pragma once

#include <string_view>

#include "scenario/yaml/source_node.h"

namespace stopline {

// Throws InputError if the file `root` is of another kind than `expected`: "scenario" or "sweep". The message says what
// the file is and how to use it.
void require_file_kind(const SourceNode& root, std::string_view expected);

}  // namespace stopline

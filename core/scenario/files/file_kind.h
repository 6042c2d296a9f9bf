// Refuses files of the wrong kind, such as a sweep given to stopline-run.
#pragma once

#include <string_view>

#include "scenario/yaml/source_node.h"

namespace stopline {

// Throws InputError if the file `root` is of another kind than `expected`, "scenario" or "sweep". The message says what
// the file is and how to use it. A file that has the characteristic field of the expected kind is not refused.
void require_file_kind(const SourceNode& root, std::string_view expected);

}  // namespace stopline

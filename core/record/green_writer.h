// Writer for the greens of all signals as CSV. It shows what controllers that react to traffic did in a run.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "record/run_writer.h"

namespace stopline {

inline constexpr const char* kGreensHeader = "population,intersection,group,lanes,start_s,end_s,green_s,red_before_s\n";

// Returns a writer that writes one row for each green of each signal group when this green ends. A green that has not
// ended by the end of the run gets a row without end. The names of the population and of lanes must not contain commas,
// quotes or line breaks, because they are not quoted. A file whose name ends with ".gz" or ".zst" is compressed.
std::unique_ptr<RunWriter> make_green_writer(const std::filesystem::path& file, const std::string& population,
                                             const Model& model);

}  // namespace stopline

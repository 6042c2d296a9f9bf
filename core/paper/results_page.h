// The results page (data/paper/RESULTS.md): all rows of the paper with our values, in Markdown.
#pragma once

#include <string>

#include "paper/scorecard.h"

namespace stopline {

// Returns the page: the main results, the number of rows by section and verdict, and one table for each section. The
// page names `command` as the command that wrote it. `findings` is Markdown text for the end of the page; it may be
// empty.
std::string results_markdown(const Scorecard& scorecard, const std::string& command, const std::string& findings);

}  // namespace stopline

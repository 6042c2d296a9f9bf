// The results page (data/paper/RESULTS.md): all rows of the paper with our values, in Markdown.
#pragma once

#include <string>

#include "paper/scorecard.h"

namespace stopline {

// Writes the page: the answer, the rows met by section, and one table for each section. `command` makes the page.
// `findings` is Markdown that is appended, and may be empty.
std::string results_markdown(const Scorecard& scorecard, const std::string& command, const std::string& findings);

}  // namespace stopline

// Texts of a scored row, shared by the report page and the results page.
#pragma once

#include <string>
#include <vector>

#include "paper/scorecard.h"

namespace stopline {

// Returns the main section that contains `section`: "IV" for "IV.C" and for "IV Table 1".
std::string main_section(const std::string& section);

// Returns the title of a main section, such as "Section IV: one intersection". Own rows have titles without a number.
std::string section_title(const std::string& main);

// Returns the main sections of the rows, each once, in the order of the rows. Only Section I is moved to the front.
std::vector<std::string> main_sections(const std::vector<ScoredRow>& rows);
// As above, without the sections of own rows.
std::vector<std::string> paper_sections(const std::vector<ScoredRow>& rows);

// Returns the quantity of a row in words: "improvement over CTG-Ref" for improvement_over_ctg_ref.
std::string quantity_text(const ScoredRow& row);

// Returns our value minus the value of the paper, as text. If the unit is not percent, the text also gives this
// difference in percent of the value of the paper. Returns an empty text unless both values are numbers.
std::string difference_text(const ScoredRow& row);

}  // namespace stopline

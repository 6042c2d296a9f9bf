// The result tables of stopline-strings as CSV. core/runs/tables/string_columns.cpp describes their columns.
#pragma once

#include <string>

#include "runs/strings/string_report.h"
#include "runs/strings/string_sweep.h"

namespace stopline {

std::string string_summary_csv(const StringReport& report);
std::string string_gains_csv(const StringReport& report);
std::string string_positions_csv(const StringReport& report);
std::string string_sweep_csv(const StringSweep& sweep);
std::string string_border_csv(const StringSweep& sweep);

}  // namespace stopline

// Result tables of stopline-strings for the terminal.
#pragma once

#include <string>

#include "runs/strings/string_report.h"
#include "runs/strings/string_sweep.h"

namespace stopline {

std::string string_text(const StringReport& report);
std::string string_sweep_text(const StringSweep& sweep);

}  // namespace stopline

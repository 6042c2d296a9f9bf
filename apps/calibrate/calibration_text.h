// Result tables of stopline-calibrate for the terminal.
#pragma once

#include <string>
#include <vector>

#include "calibration/band_check.h"
#include "calibration/calibration.h"

namespace stopline {

// Return the tables of step I: the time differences of all sets of parameters, and their values.
std::string timing_text(const std::vector<TimingResult>& results, const std::vector<CalibrationCase>& cases,
                        const AcceptedFile& accepted);
std::string parameters_text(const std::vector<TimingResult>& results);

// Returns the table of step II for one set of parameters, called `name`.
std::string bands_text(const std::string& name, const BandCheck& check);

}  // namespace stopline

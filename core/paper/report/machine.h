// Description of the machine, for the report.
#pragma once

#include <string>

namespace stopline {

// Returns for example "AMD EPYC 7B13, 2 processors, 8 GB, Debian GNU/Linux 12 (bookworm)". Parts that cannot be read
// are left out.
std::string machine_text();

}  // namespace stopline

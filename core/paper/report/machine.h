// Description of the computer on which the program runs, for the report.
#pragma once

#include <string>

namespace stopline {

// Returns processor, memory and operating system, such as "AMD EPYC 7B13, 2 processors, 8 GB, Debian GNU/Linux 12
// (bookworm)". The text omits parts that cannot be read.
std::string machine_text();

}  // namespace stopline

// Which machine a report was made on.
#pragma once

#include <string>

namespace stopline {

// "AMD EPYC 7B13, 2 processors, 8 GB, Debian GNU/Linux 12 (bookworm)": the same each time on one machine. What cannot be read is left out.
std::string machine_text();

}  // namespace stopline

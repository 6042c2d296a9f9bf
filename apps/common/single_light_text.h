// The results of a single light as tables for the terminal.
#pragma once

#include <string>

#include "experiment/single_light.h"

namespace stopline {

std::string counts_text(const SingleLight& result);      // vehicles passed and improvement, by green time
std::string ideal_text(const SingleLight& result);       // the same of ideal platoons, and both gains
std::string headways_text(const SingleLight& result);    // at the limit, beside what the policies say, and at the line
std::string queue_text(const SingleLight& result);       // where a queue has not closed up; empty if all have
std::string violations_text(const SingleLight& result);  // one line if there are none

}  // namespace stopline

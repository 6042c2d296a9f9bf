// The version of this build, for the option --version and for the files that say how a result was made.
#pragma once

namespace stopline {

// Returns project version and git revision, such as "0.1.0 (1a2b3c4-dirty)". The revision of a build without git is
// "unknown".
const char* version();

}  // namespace stopline

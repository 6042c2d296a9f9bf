// The version of this build, for --version and for the provenance of results.
#pragma once

namespace stopline {

// Returns project version and git revision, such as "0.1.0 (1a2b3c4-dirty)". Without git the revision is "unknown".
const char* version();

}  // namespace stopline

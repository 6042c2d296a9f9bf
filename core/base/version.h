// Which Stopline this is: for --version and for the provenance of results.
#pragma once

namespace stopline {

// Project version and git revision, such as "0.1.0 (1a2b3c4-dirty)"; the revision is "unknown" outside a git work tree.
const char* version();

}  // namespace stopline

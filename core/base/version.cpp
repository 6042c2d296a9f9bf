#include "base/version.h"

#include "version_text.h"  // written by the build

namespace stopline {

const char* version() { return STOPLINE_VERSION_TEXT; }

}  // namespace stopline

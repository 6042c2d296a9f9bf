// The words of YAML inputs, from the field tables: keys, paths and values.
#pragma once

#include <string>
#include <vector>

namespace stopline::fuzz {

struct Catalogue {
    std::vector<std::string> keys;    // names of fields, present and old ones
    std::vector<std::string> paths;   // paths of fields, such as "signal.green" or "populations[0].name"
    std::vector<std::string> values;  // choices, defaults, quantities of all units, and unusual values
};

const Catalogue& catalogue();

}  // namespace stopline::fuzz

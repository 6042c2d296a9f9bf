// The exception for a computation that the user has stopped. The program then ends with exit code 130.
#pragma once

#include <stdexcept>

namespace stopline {

class Interrupted : public std::runtime_error {
public:
    Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace stopline

// The one exception type for bad input: what the user wrote cannot be used. Programs catch it, print it and exit with 2.
#pragma once

#include <stdexcept>
#include <string>

namespace stopline {

class InputError : public std::runtime_error {
public:
    explicit InputError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace stopline

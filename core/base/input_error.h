// The exception for unusable user input. Programs catch it, print its message and exit with status 2.
#pragma once

#include <stdexcept>
#include <string>

namespace stopline {

class InputError : public std::runtime_error {
public:
    explicit InputError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace stopline

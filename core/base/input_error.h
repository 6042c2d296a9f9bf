// The exception for unusable user input. Programs catch it, print its message and exit with status 2.
#pragma once

#include <stdexcept>
#include <string>

namespace stopline {

class InputError : public std::runtime_error {
public:
    // Messages often quote the input. They are therefore made printable (base/io/printable.h).
    explicit InputError(const std::string& message);
};

}  // namespace stopline

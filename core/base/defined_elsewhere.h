// A macro for lists of constants that other files define, such as the list of spacing laws. One line adds a constant.
#pragma once

// Declares the constant `name`, which another file of the namespace defines, and returns its address. Do not use the
// macro inside an unnamed namespace.
#define STOPLINE_DEFINED_ELSEWHERE(Type, name) \
    [] {                                       \
        extern const Type name;                \
        return &(name);                        \
    }()

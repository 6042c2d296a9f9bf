// Lists of constants that other files define, such as the spacing laws: one line adds a constant to a list.
#pragma once

// Declares the constant `name`, which another file of the namespace defines, and yields its address. Not for use inside
// an unnamed namespace.
#define STOPLINE_DEFINED_ELSEWHERE(Type, name) \
    [] {                                       \
        extern const Type name;                \
        return &name;                          \
    }()

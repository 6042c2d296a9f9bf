// Formulas for the net gap as a function of speed, such as "s0 + 0.4 s * v + 0.01 s2/m * v^2".
//
// A formula combines numbers with units, the speed v and the standstill gap s0. It can use the operators + - * / ^,
// parentheses, and the functions min(a, b, ...), max(a, b, ...), sqrt(a) and if(a < b, c, d). The function `if` returns
// c if the comparison holds, else d. Comparisons are < <= > and >=. Exponents are whole numbers from 0 to 9.
//
// A unit is one of m, km, s, ms and h, or a quotient of them. Each can have an exponent from 2 to 9, such as s2/m. A
// number without unit has no dimension. The parser checks the dimensions of all terms.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace stopline {

class GapFormula {
public:
    // The first error in a text. `message` is empty if there is none.
    struct Error {
        std::size_t position = 0;  // index of the first character of the wrong part
        std::string message;
    };

    struct Node;  // one operation, number or symbol; defined in formula.cpp

    // Reads a formula for a gap in m. If the text has an error, sets `error` and returns a formula that must not be
    // evaluated.
    static GapFormula parse(std::string_view text, Error& error);

    // Returns the gap in m. It is not finite if the formula divides by 0 or takes the root of a negative number.
    double gap_m(double standstill_gap_m, double speed_mps) const;

private:
    std::shared_ptr<const Node> root_;
};

}  // namespace stopline

#include "spacing_laws/formula.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace stopline {

// The exponents of metre and second in the dimension of a term: a speed is {1, -1}.
struct FormulaDimension {
    int metre = 0;
    int second = 0;
    bool operator==(const FormulaDimension&) const = default;
};

struct GapFormula::Node {
    enum class Kind {
        number,
        speed,
        standstill_gap,
        sum,
        difference,
        product,
        quotient,
        power,
        min,
        max,
        root,
        choice
    };
    Kind kind = Kind::number;
    double value = 0.0;  // number: in SI units; power: the exponent
    // choice: the two sides of the comparison, the value if it holds, and the value if not
    std::vector<Node> operands;
    bool or_equal = false;  // choice: true for <=, and for >=, which is stored as <= with exchanged sides
    FormulaDimension dimension;
    std::size_t begin = 0;  // the characters of the term in the text: [begin, end)
    std::size_t end = 0;
};

namespace {

using Node = GapFormula::Node;
using Kind = Node::Kind;
using Dimension = FormulaDimension;

constexpr int kMaxDepth = 50;  // of nested parentheses and functions
constexpr std::size_t kMaxLength = 1000;
constexpr int kMaxUnitExponent = 100;  // largest exponent of a unit, such as 4 in m4
constexpr Dimension kLength{1, 0};

std::string power_text(const char* base, int exponent) {
    return exponent == 1 ? std::string(base) : fmt::format("{}{}", base, exponent);
}

// Returns the unit of a dimension in SI, such as "m/s2".
std::string unit_text(const Dimension& d) {
    std::vector<std::string> above;
    std::vector<std::string> below;
    for (const auto& [base, exponent] : {std::pair{"m", d.metre}, std::pair{"s", d.second}}) {
        if (exponent > 0) above.push_back(power_text(base, exponent));
        if (exponent < 0) below.push_back(power_text(base, -exponent));
    }
    std::string text = above.empty() ? "1" : above[0];
    for (std::size_t k = 1; k < above.size(); ++k) text += " " + above[k];
    for (const std::string& one : below) text += "/" + one;
    return text;
}

// Returns "has the unit m/s2" or, without a dimension, "has no unit".
std::string has_unit(const Dimension& d) { return d == Dimension{} ? "has no unit" : "has the unit " + unit_text(d); }

struct BaseUnit {
    std::string_view name;
    double factor;
    Dimension dimension;
};
constexpr std::array kBaseUnits{
    BaseUnit{"m", 1.0, {1, 0}},     BaseUnit{"km", 1000.0, {1, 0}}, BaseUnit{"s", 1.0, {0, 1}},
    BaseUnit{"ms", 1.0e-3, {0, 1}}, BaseUnit{"h", 3600.0, {0, 1}},
};

// A recursive-descent parser. Each parse function reads one construct of the grammar and returns its node. The first
// error is thrown as a Failure and ends the parsing. Exception: an error in the units of two terms is kept until the
// end of the text, because a syntax error further on is often its cause.
class Parser {
public:
    struct Failure {
        GapFormula::Error error;
    };

    explicit Parser(std::string_view text) : text_(text) {}

    Node formula() {
        if (text_.size() > kMaxLength) fail(0, fmt::format("a formula has at most {} characters", kMaxLength));
        Node node = sum();
        if (!at_end()) {
            fail(at_, fmt::format("'{}' is not expected here; write * between factors", rest()));
        }
        if (first_unit_error_) throw Failure{*first_unit_error_};
        if (node.dimension != kLength) {
            fail(node.begin, fmt::format("the formula {}, but a gap has the unit m", has_unit(node.dimension)));
        }
        return node;
    }

private:
    [[noreturn]] static void fail(std::size_t position, std::string message) {
        throw Failure{{position, std::move(message)}};
    }

    void skip_spaces() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
    }
    bool at_end() {
        skip_spaces();
        return at_ == text_.size();
    }
    // Returns the next character after spaces; '\0' at the end of the text.
    char next() { return at_end() ? '\0' : text_[at_]; }
    bool take(char c) {
        if (next() != c) return false;
        ++at_;
        return true;
    }
    void expect(char c) {
        if (!take(c))
            fail(at_, at_end() ? fmt::format("'{}' is missing at the end", c)
                               : fmt::format("'{}' is missing before '{}'", c, rest()));
    }
    // Returns the text from the current position on, at most 20 characters.
    std::string rest() const { return std::string(text_.substr(at_, 20)); }
    std::string text_of(const Node& node) const { return std::string(text_.substr(node.begin, node.end - node.begin)); }

    Node made(Kind kind, std::vector<Node> operands, const Dimension& dimension, std::size_t begin) const {
        Node node;
        node.kind = kind;
        node.operands = std::move(operands);
        node.dimension = dimension;
        node.begin = begin;
        node.end = at_;
        return node;
    }

    void require_equal_dimensions(const Node& a, const Node& b) {
        if (a.dimension == b.dimension || first_unit_error_) return;
        first_unit_error_ = GapFormula::Error{
            b.begin,
            fmt::format("'{}' {}, but '{}' {}: only values of the same unit can be added, subtracted or compared",
                        text_of(b), has_unit(b.dimension), text_of(a), has_unit(a.dimension))};
    }

    Node sum() {
        Node left = product();
        while (next() == '+' || next() == '-') {
            const Kind kind = text_[at_++] == '+' ? Kind::sum : Kind::difference;
            Node right = product();
            require_equal_dimensions(left, right);
            const Dimension dimension = left.dimension;
            const std::size_t begin = left.begin;
            left = made(kind, pair(std::move(left), std::move(right)), dimension, begin);
        }
        return left;
    }

    Node product() {
        Node left = factor();
        while (next() == '*' || next() == '/') {
            const bool times = text_[at_++] == '*';
            Node right = factor();
            const int sign = times ? 1 : -1;
            const Dimension dimension{left.dimension.metre + sign * right.dimension.metre,
                                      left.dimension.second + sign * right.dimension.second};
            const std::size_t begin = left.begin;
            left =
                made(times ? Kind::product : Kind::quotient, pair(std::move(left), std::move(right)), dimension, begin);
        }
        return left;
    }

    // Reads an operand with its optional sign and exponent. The exponent applies before the sign.
    Node factor() {
        const bool negative = next() == '-';
        const std::size_t begin = at_;
        if (negative) ++at_;
        Node base = primary();
        if (take('^')) base = power(std::move(base));
        if (!negative) return base;
        Node zero = made(Kind::number, {}, base.dimension, begin);
        const Dimension dimension = base.dimension;
        return made(Kind::difference, pair(std::move(zero), std::move(base)), dimension, begin);
    }

    Node power(Node base) {
        const char digit = next();
        if (std::isdigit(static_cast<unsigned char>(digit)) == 0) {
            fail(at_, "an exponent is a whole number from 0 to 9");
        }
        ++at_;
        if (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '.')) {
            fail(at_ - 1, "an exponent is a whole number from 0 to 9");
        }
        const int exponent = digit - '0';
        const Dimension dimension{exponent * base.dimension.metre, exponent * base.dimension.second};
        const std::size_t begin = base.begin;
        if (std::max(std::abs(dimension.metre), std::abs(dimension.second)) > kMaxUnitExponent)
            fail(begin, fmt::format("{} has an exponent above {}", unit_text(dimension), kMaxUnitExponent));
        Node node = made(Kind::power, {std::move(base)}, dimension, begin);
        node.value = exponent;
        return node;
    }

    Node primary() {
        if (++depth_ > kMaxDepth) fail(at_, fmt::format("parentheses are nested more than {} deep", kMaxDepth));
        Node node = read_primary();
        --depth_;
        return node;
    }

    Node read_primary() {
        const char c = next();
        const std::size_t begin = at_;
        if (take('(')) {
            Node node = sum();
            expect(')');
            node.begin = begin;
            node.end = at_;
            return node;
        }
        if (std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.') return number();
        if (std::isalpha(static_cast<unsigned char>(c)) != 0) return named();
        fail(at_, at_end() ? "a value is missing at the end" : fmt::format("'{}' is not a value", rest()));
    }

    // Reads the letters, digits and underscores from the current position on.
    std::string_view word() {
        const std::size_t begin = at_;
        while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_'))
            ++at_;
        return text_.substr(begin, at_ - begin);
    }

    Node number() {
        const std::size_t begin = at_;
        double value = 0.0;
        const auto [end, code] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (code != std::errc()) fail(at_, fmt::format("'{}' is not a number", rest()));
        at_ = static_cast<std::size_t>(end - text_.data());
        Dimension dimension;
        double factor = 1.0;
        const std::size_t after_number = at_;
        if (take_unit(1, factor, dimension)) {
            while (true) {
                const std::size_t before = at_;
                if (!take('/') || !take_unit(-1, factor, dimension)) {
                    at_ = before;
                    break;
                }
            }
        } else {
            at_ = after_number;
            if (std::isalpha(static_cast<unsigned char>(next())) != 0) {
                const std::size_t begin_of_word = at_;
                fail(begin_of_word,
                     fmt::format("'{}' is not a unit; units are m, km, s, ms, h and quotients such as s2/m or km/h. "
                                 "Write * between factors",
                                 word()));
            }
            at_ = after_number;
        }
        Node node = made(Kind::number, {}, dimension, begin);
        node.value = value * factor;
        return node;
    }

    // Reads a base unit with its exponent, such as "s2" or "s^2". `sign` is 1 for a unit before '/', and -1 after it.
    // Returns false if no unit follows. The caller must then restore the position.
    bool take_unit(int sign, double& factor, Dimension& dimension) {
        skip_spaces();
        std::string_view name = word();
        int exponent = 1;
        std::size_t caret_and_digit = 0;  // characters of an exponent such as "^2"
        if (name.size() > 1 && name.back() >= '2' && name.back() <= '9') {
            exponent = name.back() - '0';
            name.remove_suffix(1);
        } else if (at_ + 1 < text_.size() && text_[at_] == '^' && text_[at_ + 1] >= '2' && text_[at_ + 1] <= '9') {
            exponent = text_[at_ + 1] - '0';
            caret_and_digit = 2;
        }
        const auto* const base =
            std::find_if(kBaseUnits.begin(), kBaseUnits.end(), [&](const BaseUnit& one) { return one.name == name; });
        if (base == kBaseUnits.end()) return false;
        at_ += caret_and_digit;
        for (int k = 0; k < exponent; ++k) factor = sign > 0 ? factor * base->factor : factor / base->factor;
        dimension.metre += sign * exponent * base->dimension.metre;
        dimension.second += sign * exponent * base->dimension.second;
        return true;
    }

    Node named() {
        const std::size_t begin = at_;
        const std::string name(word());
        if (name == "v") return made(Kind::speed, {}, {1, -1}, begin);
        if (name == "s0") return made(Kind::standstill_gap, {}, kLength, begin);
        if (name == "min" || name == "max") return least_or_greatest(name == "min" ? Kind::min : Kind::max, begin);
        if (name == "sqrt") return root(begin);
        if (name == "if") return choice(begin);
        fail(begin,
             fmt::format("there is no '{}'; known are v (speed), s0 (standstill gap), min, max, sqrt and if", name));
    }

    Node least_or_greatest(Kind kind, std::size_t begin) {
        std::vector<Node> operands;
        expect('(');
        do {
            operands.push_back(sum());
            require_equal_dimensions(operands.front(), operands.back());
        } while (take(','));
        expect(')');
        const Dimension dimension = operands.front().dimension;
        return made(kind, std::move(operands), dimension, begin);
    }

    Node root(std::size_t begin) {
        expect('(');
        std::vector<Node> operands;
        operands.push_back(sum());
        expect(')');
        const Dimension of = operands.front().dimension;
        if (of.metre % 2 != 0 || of.second % 2 != 0) {
            fail(operands.front().begin, fmt::format("'{}' has the unit {}, whose root is not a unit",
                                                     text_of(operands.front()), unit_text(of)));
        }
        return made(Kind::root, std::move(operands), {of.metre / 2, of.second / 2}, begin);
    }

    Node choice(std::size_t begin) {
        expect('(');
        Node left = sum();
        const char comparison = next();
        if (comparison != '<' && comparison != '>') fail(at_, "if needs a comparison: <, <=, > or >=");
        ++at_;
        const bool or_equal = at_ < text_.size() && text_[at_] == '=';
        if (or_equal) ++at_;
        Node right = sum();
        require_equal_dimensions(left, right);
        expect(',');
        Node if_true = sum();
        expect(',');
        Node if_false = sum();
        require_equal_dimensions(if_true, if_false);
        expect(')');
        const Dimension dimension = if_true.dimension;
        if (comparison == '>') std::swap(left, right);
        std::vector<Node> operands = pair(std::move(left), std::move(right));
        operands.push_back(std::move(if_true));
        operands.push_back(std::move(if_false));
        Node node = made(Kind::choice, std::move(operands), dimension, begin);
        node.or_equal = or_equal;
        return node;
    }

    static std::vector<Node> pair(Node a, Node b) {
        std::vector<Node> both;
        both.reserve(2);
        both.push_back(std::move(a));
        both.push_back(std::move(b));
        return both;
    }

    std::string_view text_;
    std::size_t at_ = 0;  // position of the next character
    int depth_ = 0;
    std::optional<GapFormula::Error> first_unit_error_;
};

// The values of the symbols.
struct Symbols {
    double standstill_gap_m;
    double speed_mps;
};

double value_of(const Node& node, const Symbols& symbols) {
    const auto operand = [&](std::size_t k) { return value_of(node.operands[k], symbols); };
    const auto fold = [&](auto keep) {
        double result = operand(0);
        for (std::size_t k = 1; k < node.operands.size(); ++k) result = keep(result, operand(k));
        return result;
    };
    switch (node.kind) {
        case Kind::number:
            return node.value;
        case Kind::speed:
            return symbols.speed_mps;
        case Kind::standstill_gap:
            return symbols.standstill_gap_m;
        case Kind::sum:
            return operand(0) + operand(1);
        case Kind::difference:
            return operand(0) - operand(1);
        case Kind::product:
            return operand(0) * operand(1);
        case Kind::quotient:
            return operand(0) / operand(1);
        case Kind::power: {
            const double base = operand(0);
            double result = 1.0;
            for (int k = 0; k < static_cast<int>(node.value); ++k) result *= base;
            return result;
        }
        case Kind::min:
            return fold([](double a, double b) { return b < a || std::isnan(b) ? b : a; });
        case Kind::max:
            return fold([](double a, double b) { return b > a || std::isnan(b) ? b : a; });
        case Kind::root:
            return std::sqrt(operand(0));
        case Kind::choice: {
            const bool holds = node.or_equal ? operand(0) <= operand(1) : operand(0) < operand(1);
            return operand(holds ? 2 : 3);
        }
    }
    return 0.0;
}

}  // namespace

GapFormula GapFormula::parse(std::string_view text, Error& error) {
    GapFormula formula;
    error = {};
    try {
        formula.root_ = std::make_shared<Node>(Parser(text).formula());
    } catch (const Parser::Failure& failure) {
        error = failure.error;
    }
    return formula;
}

double GapFormula::gap_m(double standstill_gap_m, double speed_mps) const {
    return value_of(*root_, {standstill_gap_m, speed_mps});
}

}  // namespace stopline

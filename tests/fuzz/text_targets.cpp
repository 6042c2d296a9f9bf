// Targets that read short texts: quantities, formulas and overrides.
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/outcome.h"
#include "fuzz/targets.h"
#include "scenario/load_scenario.h"
#include "scenario/schema/quantity.h"
#include "spacing_laws/formula.h"

namespace stopline::fuzz {

// The first byte of the input chooses the expected unit. A quantity that is accepted must survive writing and reading.
void run_quantities(std::string_view input) {
    if (input.empty()) return;
    const Unit& expected = units()[static_cast<unsigned char>(input.front()) % units().size()];
    const std::string_view text = input.substr(1);
    const ParsedQuantity quantity = parse_quantity(text, expected);
    if (quantity.problem.empty()) {
        const ParsedQuantity again = parse_quantity(exact_text(quantity.si, expected), expected);
        require(again.problem.empty() && again.si == quantity.si, "exact_text() gives the same quantity");
        require(!short_text(quantity.si, expected).empty(), "short_text() gives a text");
    }
    const ParsedWhole whole = parse_whole(text);
    if (!whole.problem.empty()) return;
    require(parse_whole(std::to_string(whole.value)).value == whole.value, "a whole number is read as it was written");
}

void run_formulas(std::string_view input) {
    GapFormula::Error error;
    const GapFormula formula = GapFormula::parse(input, error);
    if (!error.message.empty()) {
        require(error.position <= input.size(), "the position of an error lies in the text");
        return;
    }
    for (const double speed_mps : {0.0, 1.0, 13.9, 50.0}) static_cast<void>(formula.gap_m(2.0, speed_mps));
}

// Each line of the input is an override of one small scenario.
void run_overrides(std::string_view input) {
    constexpr std::string_view kScenario = "network: {kind: intersection}\n";
    constexpr std::size_t kMaxOverrides = 20;
    std::vector<std::string> overrides;
    while (!input.empty() && overrides.size() < kMaxOverrides) {
        const std::size_t end = std::min(input.find('\n'), input.size());
        overrides.emplace_back(input.substr(0, end));
        input.remove_prefix(std::min(end + 1, input.size()));
    }
    expect_success_or_input_error([&] { static_cast<void>(parse_scenario(kScenario, "fuzz.yaml", overrides)); });
}

}  // namespace stopline::fuzz

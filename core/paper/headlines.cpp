#include "paper/headlines.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/args.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/io/csv.h"

namespace stopline {

namespace {

// A sentence about rows of the scorecard. It has one placeholder {} for each row, which is replaced by our value.
struct Statement {
    std::vector<const char*> rows;  // row ids
    const char* sentence;
    const char* topic;  // name of the statement if its values are missing
};

// Returns our value of a row of the scorecard, or std::nullopt if the row is missing or our answer is not a number.
std::optional<double> value_of_row(const Scorecard& scorecard, const std::string& id) {
    const auto found = std::find_if(scorecard.rows.begin(), scorecard.rows.end(),
                                    [&](const ScoredRow& row) { return row.target.id == id; });
    return found == scorecard.rows.end() ? std::nullopt : parse_number(found->ours);
}

// Returns the sentence with our values, or an empty text if a value is missing.
std::string sentence_of(const Scorecard& scorecard, const Statement& statement) {
    fmt::dynamic_format_arg_store<fmt::format_context> values;
    for (const char* const id : statement.rows) {
        const std::optional<double> value = value_of_row(scorecard, id);
        if (!value) return "";
        values.push_back(fmt::format("{:.0f}", *value + 0.0));  // + 0.0 turns -0 into 0
    }
    return fmt::vformat(statement.sentence, values);
}

std::string text_of(const Scorecard& scorecard, const std::vector<Statement>& statements) {
    std::vector<std::string> sentences;
    std::vector<std::string> missing;
    for (const Statement& statement : statements) {
        std::string sentence = sentence_of(scorecard, statement);
        if (sentence.empty()) {
            missing.emplace_back(statement.topic);
        } else {
            sentences.push_back(std::move(sentence));
        }
    }
    if (!missing.empty()) {
        sentences.push_back(fmt::format("Not measured in these runs: {}.", fmt::join(missing, ", ")));
    }
    return fmt::format("{}", fmt::join(sentences, " "));
}

}  // namespace

std::vector<Headline> headlines(const Scorecard& scorecard) {
    const std::vector<Statement> signal{
        {{"L01", "L05"},
         "In 15 s of green {} vehicles pass the stop line with CDG and {} with CTG-Ref.",
         "vehicles in 15 s of green"},
        {{"L09"}, "With greens of 30 s and more, CDG gains {} % in throughput.", "gain with long greens"}};
    const std::vector<Statement> intersection{
        {{"T03", "T39"},
         "With 15 s of green CDG gains {} % in throughput without turns, and {} % with 30 % left and 30 % right turns.",
         "gain of CDG"},
        {{"T09"}, "If half of the vehicles are CDG, the gain without turns is {} %.", "gain of a mix"}};
    const std::vector<Statement> networks{
        {{"A05"}, "CDG gains {} % on the arterial without turns from the major street.", "arterial"},
        {{"G01"}, "It gains {} % on the grid without turns and with 10 s of green.", "grid"},
        {{"B04"}, "It gains {} % in Berlin.", "Berlin"}};
    const std::vector<Statement> cost{
        {{"G07", "G08"},
         "On the grid with turns CDG gains {} % with greens up to 10 s, but {} % with greens of 15 and 20 s without "
         "offset, because its long platoons block junctions.",
         "gain of CDG on the grid with turns"},
        {{"G06"},
         "A mix with half CDG gains {} % on this grid, mean of all greens and offsets.",
         "gain of a mix on the grid with turns"}};
    return {{"One signal", text_of(scorecard, signal)},
            {"One intersection", text_of(scorecard, intersection)},
            {"Networks", text_of(scorecard, networks)},
            {"Cost", text_of(scorecard, cost)},
            {"Agreement with the paper", results_text(scorecard)}};
}

std::string results_text(const Scorecard& scorecard) {
    const int own = scorecard.count(Verdict::own);
    const int others = scorecard.count(Verdict::input) + own;
    const std::string further = own > 0 ? fmt::format(" {} further rows hold results of our own.", own) : "";
    return fmt::format("Of {} rows with results {} are inside their tolerance, {} outside, and {} open.{}",
                       static_cast<int>(scorecard.rows.size()) - others, scorecard.count(Verdict::inside),
                       scorecard.count(Verdict::miss), scorecard.count(Verdict::open), further);
}

}  // namespace stopline

// Tests of every row of the field tables. An invalid value gives an error that names the line and the path of the
// field. A valid value is stored in the struct member of the field and written by canonical_text(). New rows are tested
// without a change here.
#include "scenario/schema/field_table.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>
#include <random>
#include <set>

#include "scenario/scenario_text.h"
#include "scenario/schema/fields.h"
#include "scenario/yaml/yaml_source.h"

namespace stopline {
namespace {

// A field and its place in a text.
struct Leaf {
    std::string path;
    const Field* field;
    Place key;
    Place value;
    std::string text;  // the value, if it is a scalar
};

void collect(const Table& table, const SourceNode& map, const std::string& path, std::vector<Leaf>& leaves) {
    for (std::size_t i = 0; i < map.keys.size(); ++i) {
        const Field* const field = table.find(map.keys[i].text);
        ASSERT_NE(field, nullptr) << map.keys[i].text;
        const std::string field_path = join_path(path, field->name);
        leaves.push_back({field_path, field, map.keys[i].place, map.items[i].place, map.items[i].text});
        if (const auto* const section = std::get_if<SectionField>(&field->kind)) {
            collect(section->table(), map.items[i], field_path, leaves);
        } else if (const auto* const list = std::get_if<ListField>(&field->kind)) {
            for (std::size_t k = 0; k < map.items[i].items.size(); ++k) {
                const SourceNode& item = map.items[i].items[k];
                const SourceNode* const name = item.find("name");
                collect(list->table(), item, field_path + "[" + (name ? name->text : std::to_string(k)) + "]", leaves);
            }
        }
    }
}

// A scenario with every field of every table.
class EveryField : public ::testing::TestWithParam<const char*> {
protected:
    EveryField() {
        text_ = canonical_text(load_scenario(shipped(GetParam())));
        const SourceNode root = parse_yaml(text_, std::make_shared<Source>(Source{"test.yaml", "."}));
        collect(scenario_table(), root, "", leaves_);
    }

    std::size_t offset(const Place& place) const {
        std::size_t at = 0;
        for (int line = 1; line < place.line; ++line) at = text_.find('\n', at) + 1;
        return at + static_cast<std::size_t>(place.column) - 1;
    }

    // Returns the text of the scenario, with `value` instead of everything from `place` to the end of the line.
    std::string replaced(const Place& place, const std::string& value) const {
        const std::size_t begin = offset(place);
        return text_.substr(0, begin) + value + text_.substr(text_.find('\n', begin));
    }
    // Returns the text with a word inserted at a place.
    std::string inserted(const Place& place, const std::string& word) const {
        const std::size_t begin = offset(place);
        return text_.substr(0, begin) + word + text_.substr(begin);
    }

    // Expects an error for `value` in a field. The message has the place of the field and the remark.
    void expect_refused(const Leaf& leaf, const std::string& value, const std::string& remark) const {
        const std::string message = error_of(replaced(leaf.value, value));
        EXPECT_TRUE(contains(message, to_string(leaf.value) + ": field '" + leaf.path)) << value;
        EXPECT_TRUE(contains(message, remark)) << leaf.path << ": " << value;
    }

    std::string text_;
    std::vector<Leaf> leaves_;
};

std::string other_unit(const Unit& shown) { return shown.dimension == Dimension::mass ? "s" : "kg"; }

std::string quantity(double value, const Unit& shown) {
    char text[64];
    static_cast<void>(std::snprintf(text, sizeof text, "%.17g %s", value, std::string(shown.text).c_str()));
    return text;
}

INSTANTIATE_TEST_SUITE_P(Shipped, EveryField,
                         ::testing::Values("scenarios/single_light.yaml", "scenarios/intersection.yaml"),
                         [](const auto& file) {
                             return file.param == std::string("scenarios/intersection.yaml") ? "Intersection"
                                                                                             : "SingleLight";
                         });

TEST_P(EveryField, AppearsInTheCanonicalText) {
    std::set<const Field*> listed;
    std::set<std::string> values;  // values of all scalar fields of the scenario
    for (const Leaf& leaf : leaves_) {
        listed.insert(leaf.field);
        values.insert(leaf.text);
    }
    std::vector<const Table*> tables{&scenario_table(),   &network_table(),    &signal_table(),
                                     &demand_table(),     &vehicle_table(),    &driver_table(),
                                     &gap_policy_table(), &population_table(), &measure_table()};
    for (const Table* const table : tables) {
        for (const Field& field : table->fields) {
            const auto chosen = [&](const std::string& value) { return values.contains(value); };
            const bool expected = field.condition_values.empty() ||
                                  std::any_of(field.condition_values.begin(), field.condition_values.end(), chosen);
            EXPECT_EQ(listed.contains(&field), expected) << table->title << ": " << field.name;
        }
    }
    EXPECT_GT(listed.size(), 80u);
}

TEST_P(EveryField, HasAMeaningAndAnAllowedRange) {
    for (const Leaf& leaf : leaves_) {
        EXPECT_FALSE(leaf.field->meaning.empty()) << leaf.path;
        EXPECT_FALSE(allowed_text(leaf.field->kind).empty()) << leaf.path;
        if (const auto* const number = std::get_if<NumberField>(&leaf.field->kind)) {
            EXPECT_LT(number->range.min, number->range.max) << leaf.path;
        }
    }
}

TEST_P(EveryField, RefusesAMisspeltKeyWithTheRightOne) {
    for (const Leaf& leaf : leaves_) {
        const std::string message = error_of(inserted(leaf.key, "q"));
        const std::string path =
            leaf.path.substr(0, leaf.path.size() - leaf.field->name.size()) + "q" + leaf.field->name;
        EXPECT_TRUE(contains(message, to_string(leaf.key) + ": field '"));
        // If the misspelt key is the name of a list entry, the path has the index of the entry instead of its name.
        EXPECT_TRUE(leaf.field->name == "name" || contains(message, "field '" + path + "' is unknown"));
        EXPECT_TRUE(contains(message, "did you mean '" + leaf.field->name + "'?"));
    }
}

TEST_P(EveryField, NumbersRefuseInvalidValues) {
    int fields = 0;
    for (const Leaf& leaf : leaves_) {
        const auto* const f = std::get_if<NumberField>(&leaf.field->kind);
        if (f == nullptr) continue;
        ++fields;
        const Unit& shown = *f->unit;
        for (const char* word : {"nan", ".nan", "inf", "-.inf"}) expect_refused(leaf, word, "is not a finite number");
        for (const char* word : {"abc", "\"\"", "true", "--1"}) expect_refused(leaf, word, "is not a number");
        expect_refused(leaf, "1e999 " + std::string(shown.text), "is too large");
        expect_refused(leaf, "1 " + other_unit(shown),
                       shown.dimension == Dimension::number ? "has a unit" : "is needed");
        expect_refused(leaf, "1 furlong", shown.dimension == Dimension::number ? "has a unit" : "known here: ");
        const bool is_share = shown.dimension == Dimension::share;
        if (!is_share) {
            expect_refused(leaf, "1 fraction", shown.dimension == Dimension::number ? "has a unit" : "is needed");
        }
        EXPECT_TRUE(contains(error_of(replaced(leaf.value, "")),
                             to_string(leaf.key) + ": field '" + leaf.path + "': needs a single value, not nothing"));
        expect_refused(leaf, "[1, 2]", "needs a single value, not a list");
        expect_refused(leaf, "{a: 1}", "needs a single value, not a map");
        if (!shown.text.empty()) {
            expect_refused(leaf, "1", is_share ? "has no unit: write '1 " : "has no unit: write e.g. '1 ");
        }
        const double step = 1e-6 * std::max(1.0, std::abs(f->range.min));
        expect_refused(leaf, quantity(f->range.min - step, shown), "is out of range (allowed: ");
        expect_refused(leaf, quantity(f->range.max * (1 + 1e-6) + step, shown), "is out of range (allowed: ");
        for (const double end :
             {f->range.min, f->range.max}) {  // both ends are in range; checks with other fields may still fail
            const std::string message = error_of(replaced(leaf.value, quantity(end, shown)));
            EXPECT_EQ(message.find("is out of range"), std::string::npos) << message;
        }
    }
    EXPECT_GT(fields, 60);
}

TEST_P(EveryField, WholeNumbersRefuseInvalidValues) {
    for (const Leaf& leaf : leaves_) {
        const auto* const f = std::get_if<WholeField>(&leaf.field->kind);
        if (f == nullptr) continue;
        for (const char* word : {"-1", "1.5", "1e3", "nan", "1 s", "abc", "50 %", "\"\""}) {
            expect_refused(leaf, word, "is not a whole number");
        }
        expect_refused(leaf, "99999999999999999999", "is above the maximum of 18446744073709551615");
        expect_refused(leaf, "[1]", "needs a single value");
        if (f->range.min > 0) expect_refused(leaf, std::to_string(f->range.min - 1), "is out of range");
        if (f->range.max < ~std::uint64_t{0}) expect_refused(leaf, std::to_string(f->range.max + 1), "is out of range");
    }
}

TEST_P(EveryField, TextsAndChoicesRefuseInvalidValues) {
    for (const Leaf& leaf : leaves_) {
        if (const auto* const text = std::get_if<TextField>(&leaf.field->kind)) {
            // If the name of a list entry is invalid, its path has the index of the entry instead of the name.
            const Leaf anonymous{leaf.path.substr(0, leaf.path.find('[')), leaf.field, leaf.key, leaf.value, ""};
            const Leaf& named = leaf.field->name == "name" ? anonymous : leaf;
            expect_refused(named, "[a]", "needs a single value");
            expect_refused(named, std::string(201, 'x'), "cannot be used as a");
            expect_refused(named, R"("a\nb")", "cannot be used as a");
            if (text->rule != TextField::Rule::name) continue;
            for (const char* word : {"a/b", R"("a,b")", "a b", R"("a\"b")", "../x", "ä", "\"\""}) {
                expect_refused(named, word, "cannot be used as a name");
            }
        } else if (const auto* const choice = std::get_if<ChoiceField>(&leaf.field->kind)) {
            ASSERT_FALSE(choice->names.empty()) << leaf.path;
            expect_refused(leaf, choice->names[0] + "x", "did you mean '" + choice->names[0] + "'?");
            expect_refused(leaf, "\"\"", "is unknown; known: " + choice->names[0]);
            expect_refused(leaf, "[" + choice->names[0] + "]", "needs a single value");
        }
    }
}

TEST_P(EveryField, ListsAndCurvesRefuseInvalidValues) {
    int fields = 0;
    for (const Leaf& leaf : leaves_) {
        if (const auto* const f = std::get_if<NumbersField>(&leaf.field->kind)) {
            const std::string entry = quantity(f->range.max, *f->unit);
            expect_refused(leaf, entry, "needs a list");
            expect_refused(leaf, "{a: 1}", "needs a list");
            const auto refused_item = [&](const std::string& item, const std::string& remark) {
                const std::string message = error_of(replaced(leaf.value, "[" + item + "]"));
                EXPECT_TRUE(contains(message, "field '" + leaf.path + "[0]': "));
                EXPECT_TRUE(contains(message, remark));
            };
            refused_item("nan", "is not a finite number");
            refused_item("[1]", "needs a single value");
            refused_item(quantity(f->range.max * 1.01, *f->unit), "is out of range");
            const std::string twice = error_of(replaced(leaf.value, "[" + entry + ", " + entry + "]"));
            EXPECT_EQ(twice.find("does not rise") != std::string::npos, f->rising) << twice;
            if (f->size.min > 0) expect_refused(leaf, "[]", "has 0 entries");
            ++fields;
        } else if (const auto* const c = std::get_if<CurveField>(&leaf.field->kind)) {
            // leaf.value is the place of the first point of the curve or, if it has no points, of the text {}.
            const bool empty = text_.compare(offset(leaf.value), 2, "{}") == 0;
            const std::string highest = quantity(c->y_range.max, *c->y_unit);
            const auto refused_point = [&](const std::string& point, const std::string& remark) {
                if (!empty) return expect_refused(leaf, point, remark);
                const std::string message = error_of(replaced(leaf.value, "{" + point + "}"));
                EXPECT_TRUE(contains(message, "field '" + leaf.path + "': "));
                EXPECT_TRUE(contains(message, remark));
            };
            refused_point("nan: nan", "is not a finite number");
            refused_point("1e7 " + std::string(c->x_unit->text) + ": " + highest, "is out of range");
            refused_point("1 " + other_unit(*c->x_unit) + ": 1", "is needed");
            const std::string last = quantity(c->x_range.max, *c->x_unit) + ": " + highest;
            const std::string lower = quantity(0.5 * c->x_range.max, *c->x_unit) + ": " + highest;
            EXPECT_TRUE(contains(error_of(replaced(leaf.value, empty ? "{" + last + ", " + lower + "}" : last)),
                                 "does not rise"));
            ++fields;
        }
    }
    EXPECT_GE(fields, 9);
}

TEST_P(EveryField, RequiredFieldsMustBePresent) {
    int fields = 0;
    for (const Leaf& leaf : leaves_) {
        const bool one_line = std::holds_alternative<NumberField>(leaf.field->kind) ||
                              std::holds_alternative<NumbersField>(leaf.field->kind);
        if (!one_line || !leaf.field->required) continue;
        const std::size_t begin = text_.rfind('\n', offset(leaf.key)) + 1;
        std::string without = text_;
        without.erase(begin, text_.find('\n', begin) + 1 - begin);
        EXPECT_TRUE(contains(error_of(without), "field '" + leaf.path + "' is missing: ")) << leaf.path;
        ++fields;
    }
    EXPECT_GT(fields, 20);
}

// If a field gets another valid value, only its own member changes: exactly one line of the canonical text differs, and
// the hash differs.
TEST_P(EveryField, AcceptsAndWritesAnotherValue) {
    const Scenario original = parse_scenario(text_, "single_light.yaml");
    ASSERT_EQ(canonical_text(original), text_);
    int tried = 0;
    int accepted = 0;
    for (const Leaf& leaf : leaves_) {
        const auto* const f = std::get_if<NumberField>(&leaf.field->kind);
        if (f == nullptr) continue;
        ++tried;
        const double old = from_si(parse_quantity(leaf.text, *f->unit).si, *f->unit);
        const double value =
            old * 1.03125 <= f->range.max && old != 0.0 ? old * 1.03125 : (f->range.min + old) / 2 + 0.015625;
        const std::string new_text = exact_text(to_si(value, *f->unit), *f->unit);
        Scenario changed;
        const std::string message =
            input_error_of([&] { changed = parse_scenario(text_, "single_light.yaml", {leaf.path + "=" + new_text}); });
        EXPECT_EQ(message.find("is out of range"), std::string::npos) << message;
        if (!message.empty()) continue;  // another check, which compares several fields, fails
        ++accepted;
        EXPECT_EQ(canonical_text(changed), replaced(leaf.value, new_text)) << leaf.path;
        EXPECT_NE(changed.hash, original.hash) << leaf.path;
    }
    EXPECT_GT(accepted, tried * 3 / 4) << "of " << tried;
}

}  // namespace
}  // namespace stopline

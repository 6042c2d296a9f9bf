// Tests of the outputs of the field tables: the canonical text of a scenario, its hash, and the list of fields.
#include <gtest/gtest.h>

#include <regex>

#include "scenario/scenario_text.h"
#include "scenario/schema/fields.h"
#include "scenario/visit_rows.h"

namespace stopline {
namespace {

TEST(CanonicalText, ReadsBackToItself) {
    for (const char* file : {"scenarios/single_light.yaml", "scenarios/first_steps.yaml"}) {
        const Scenario scenario = load_scenario(shipped(file));
        const std::string text = canonical_text(scenario);
        const Scenario reread = parse_scenario(text, "other_name.yaml");
        EXPECT_EQ(canonical_text(reread), text);
        EXPECT_EQ(reread.hash, scenario.hash);
        EXPECT_EQ(reread.vehicle_name, scenario.vehicle_name);
        EXPECT_EQ(reread.driver_name, scenario.driver_name);
    }
}

TEST(CanonicalText, KeepsTitlesUnchanged) {
    for (const std::string title :
         {"a \"quoted\" one", "back\\slash", "# no comment", "- no list", "key: value", " spaces ", "é🚦", "~", "1"}) {
        Scenario scenario = parse_scenario("name: x\n", "x.yaml");
        scenario.title = title;
        EXPECT_EQ(parse_scenario(canonical_text(scenario), "x.yaml").title, title);
    }
}

TEST(CanonicalText, KeepsAnElectricCar) {
    const Scenario scenario = parse_scenario("vehicle: electric_100kw\n", "x.yaml");
    EXPECT_EQ(canonical_text(parse_scenario(canonical_text(scenario), "x.yaml")), canonical_text(scenario));
}

TEST(Hash, IsFnv1aOfTheCanonicalText) {
    const Scenario scenario = load_scenario(shipped("scenarios/single_light.yaml"));
    std::uint64_t expected = 14695981039346656037u;
    for (const char c : canonical_text(scenario))
        expected = (expected ^ static_cast<unsigned char>(c)) * 1099511628211u;
    EXPECT_EQ(scenario.hash, expected);
}

TEST(Hash, DependsOnContentNotOnSpelling) {
    const auto hash = [](const std::string& text) { return parse_scenario(text, "x.yaml").hash; };
    EXPECT_EQ(hash("step: 10 ms\nduration: 200 s\n"), hash("# comment\nduration: 0.2e3 s\n"));
    EXPECT_EQ(hash("demand: {entry_speed: 36 km/h}\n"), hash("demand: {entry_speed: 10 m/s}\n"));
    EXPECT_EQ(hash("populations: [CDG]\n"),
              hash("populations: [{components: [{share: 100 %, policy: CDG}], pattern: alternating, name: CDG}]\n"));
    EXPECT_NE(hash("duration: 200 s\n"), hash("duration: 210 s\n"));
    EXPECT_NE(hash("populations: [CDG, CTG-Ref]\n"), hash("populations: [CTG-Ref, CDG]\n"));
    EXPECT_NE(hash("vehicle: petrol_eu4_72kw\n"), hash("vehicle: petrol_eu4_84kw\n"));
    EXPECT_NE(hash("seed: 1\n"), hash("seed: 2\n"));
}

TEST(Tables, AreWellFormed) {
    visit_rows(scenario_table(), "", [](const Table& table, const Field& field, const std::string& path) {
        EXPECT_TRUE(std::regex_match(field.name, std::regex("[a-z][a-z0-9_]*"))) << path;
        EXPECT_NE(field.name, "base") << path;  // reserved: the key `base` of a scenario file names its base file
        EXPECT_EQ(std::count_if(table.fields.begin(), table.fields.end(),
                                [&](const Field& f) { return f.name == field.name; }),
                  1)
            << path;
        EXPECT_FALSE(field.required && !field.fallback.empty()) << path;
        if (field.condition_field.empty()) return;
        // This field applies only if another field, the choice, has certain values. The choice must come before this
        // field in the table. If the choice is in a section, condition_field is SECTION.CHOICE.
        const auto dot = field.condition_field.find('.');
        const Field* choice = table.find(field.condition_field.substr(0, dot));
        ASSERT_NE(choice, nullptr) << path;
        EXPECT_LT(choice, &field) << path;
        if (dot != std::string::npos) {
            choice = std::get<SectionField>(choice->kind).table().find(field.condition_field.substr(dot + 1));
            ASSERT_NE(choice, nullptr) << path;
        }
        const auto* const names = std::get_if<ChoiceField>(&choice->kind);
        ASSERT_NE(names, nullptr) << path;
        for (const std::string& value : field.condition_values) {
            EXPECT_NE(std::find(names->names.begin(), names->names.end(), value), names->names.end()) << path;
        }
    });
}

TEST(Describe, ListsEveryField) {
    const std::string list = describe_fields();
    std::size_t rows = 0;
    visit_rows(scenario_table(), "", [&](const Table& /*table*/, const Field& field, const std::string& path) {
        const std::string parent = path.substr(0, path.size() - field.name.size());
        const std::string heading = parent.empty() ? "top level: " : parent.substr(0, parent.size() - 1) + ": ";
        const std::size_t block = list.find("\n" + heading);
        ASSERT_NE(block, std::string::npos) << heading;
        const std::size_t begin = list.find("\n  " + field.name + " ", block);
        ASSERT_LT(begin, list.find("\n\n", block)) << path;
        const std::string line = list.substr(begin + 1, list.find('\n', begin + 1) - begin - 1);
        EXPECT_TRUE(contains(line, field.meaning));
        EXPECT_TRUE(contains(line, allowed_text(field.kind)));
        EXPECT_TRUE(contains(line, unit_text(field.kind)));
        EXPECT_EQ(line.find("required") != std::string::npos, field.required) << line;
        ++rows;
    });
    EXPECT_GT(rows, 80u);
    EXPECT_TRUE(contains(list, "  speed_limit  km/h  50 km/h  5 km/h to 150 km/h  "));
    EXPECT_TRUE(contains(list, "policy: CTG-Ref, share: 50 %"));
    EXPECT_TRUE(contains(list, "Default of network.intersection.lanes:\n  [{movements: straight+left}, "));
}

}  // namespace
}  // namespace stopline

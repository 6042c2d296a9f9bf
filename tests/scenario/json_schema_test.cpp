// Tests of the JSON schema: it has every field, and it accepts and rejects the same examples as load_scenario().
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "scenario/scenario_text.h"
#include "scenario/schema/fields.h"
#include "scenario/visit_rows.h"

namespace stopline {
namespace {

using Json = nlohmann::json;

// Returns the reason why a value violates the schema, or "". Knows only the keywords that the schema uses.
std::string violation(const Json& schema, const Json& value);

bool has_type(const std::string& type, const Json& value) {
    if (type == "string") return value.is_string();
    if (type == "number") return value.is_number();
    if (type == "integer") return value.is_number_integer();
    if (type == "array") return value.is_array();
    EXPECT_EQ(type, "object");
    return value.is_object();
}

std::string object_violation(const Json& schema, const Json& value) {
    for (const auto& name : schema.value("required", Json::array())) {
        if (!value.contains(name.get<std::string>())) return "misses " + name.get<std::string>();
    }
    const Json patterns = schema.value("patternProperties", Json::object());
    for (const auto& [key, inner] : value.items()) {
        const Json* inner_schema =
            schema.contains("properties") && schema["properties"].contains(key) ? &schema["properties"][key] : nullptr;
        for (const auto& [pattern, pattern_schema] : patterns.items()) {
            if (inner_schema == nullptr && std::regex_search(key, std::regex(pattern)))
                inner_schema = &schema["patternProperties"][pattern];
        }
        if (inner_schema == nullptr) return "has the unknown " + key;
        const std::string reason = violation(*inner_schema, inner);
        if (!reason.empty()) return key + ": " + reason;
    }
    return {};
}

std::string violation(const Json& schema, const Json& value) {
    if (schema.contains("anyOf")) {
        std::string all;
        for (const Json& option : schema["anyOf"]) {
            const std::string text = violation(option, value);
            if (text.empty()) return {};
            all += "(" + text + ")";
        }
        return all;
    }
    if (schema.contains("enum"))
        return std::count(schema["enum"].begin(), schema["enum"].end(), value) == 1 ? "" : "not in the enumeration";
    const Json types = schema["type"].is_array() ? schema["type"] : Json::array({schema["type"]});
    if (std::none_of(types.begin(), types.end(), [&](const Json& type) { return has_type(type, value); })) {
        return value.dump() + " is no " + schema["type"].dump();
    }
    if (value.is_number() && value < schema.value("minimum", value)) return value.dump() + " is too small";
    if (value.is_number() && value > schema.value("maximum", value)) return value.dump() + " is too large";
    if (value.is_string() && schema.contains("pattern") &&
        !std::regex_search(value.get<std::string>(), std::regex(schema["pattern"].get<std::string>()))) {
        return value.dump() + " does not match";
    }
    if (value.is_array() && value.size() < schema.value("minItems", std::size_t{0})) return "too few";
    if (value.is_array()) {
        for (const Json& item : value) {
            const std::string reason = violation(schema["items"], item);
            if (!reason.empty()) return "[]: " + reason;
        }
    }
    return value.is_object() ? object_violation(schema, value) : "";
}

// Fails the test if the schema uses a keyword that violation() does not know.
void check_keywords(const Json& schema) {
    static const std::set<std::string> known_keywords{"$schema",
                                                      "title",
                                                      "description",
                                                      "type",
                                                      "properties",
                                                      "patternProperties",
                                                      "additionalProperties",
                                                      "required",
                                                      "anyOf",
                                                      "enum",
                                                      "pattern",
                                                      "minimum",
                                                      "maximum",
                                                      "items",
                                                      "minItems",
                                                      "maxItems",
                                                      "minProperties",
                                                      "maxProperties",
                                                      "maxLength",
                                                      "deprecated"};
    for (const auto& [key, value] : schema.items()) EXPECT_TRUE(known_keywords.contains(key)) << key;
    for (const char* map : {"properties", "patternProperties"}) {
        const Json fields = schema.value(map, Json::object());
        for (const auto& [key, inner] : fields.items()) check_keywords(inner);
    }
    for (const Json& option : schema.value("anyOf", Json::array())) check_keywords(option);
    if (schema.contains("items")) check_keywords(schema["items"]);
}

std::vector<std::string> steps_of(const std::string& path) {
    static const std::regex step("[^.\\[\\]]+");
    return {std::sregex_token_iterator(path.begin(), path.end(), step), std::sregex_token_iterator()};
}

TEST(JsonSchema, HasEveryFieldWithItsMeaning) {
    const Json schema = Json::parse(json_schema());
    EXPECT_EQ(schema["$schema"], "http://json-schema.org/draft-07/schema#");
    check_keywords(schema);
    visit_rows(scenario_table(), "", [&](const Table& /*table*/, const Field& field, const std::string& path) {
        const Json* node = &schema;
        for (const std::string& step : steps_of(path)) {
            while (node->contains("anyOf") || node->contains("items"))
                node = node->contains("anyOf") ? &node->at("anyOf").back() : &node->at("items");
            ASSERT_TRUE(node->contains("properties")) << path;
            ASSERT_TRUE(node->at("properties").contains(step)) << path;
            EXPECT_EQ(node->at("additionalProperties"), false) << path;
            node = &node->at("properties").at(step);
        }
        EXPECT_TRUE(contains(node->at("description").get<std::string>(), field.meaning)) << path;
    });
}

TEST(JsonSchema, AgreesWithTheReader) {
    const Json schema = Json::parse(json_schema());
    const auto violation_of = [&](const char* text) { return violation(schema, Json::parse(text)); };
    for (const char* good :
         {"{}", R"({"step": "10 ms", "signal": {"green": "15 s"}, "seed": 7})",
          R"({"vehicle": "petrol_eu4_72kw", "driver": {"base": "startup_kit", "cacc": {"v2v_delay": "20 ms"}}})",
          R"({"vehicle": {"base": "petrol_eu4_72kw", "full_load": {"0 rpm": "90 N m", "7000 rpm": "80 N m"}}})",
          R"({"populations": ["CDG", {"name": "A", "components": [{"policy": "CDG", "share": "50 %"}]}]})",
          R"({"measure": {"green": ["5 s", "10 s"], "baseline": "CDG"}})"}) {
        EXPECT_EQ(violation_of(good), "") << good;
    }
    for (const char* bad :
         {"[]", R"({"stepp": "10 ms"})", R"({"step": 10})", R"({"step": "10"})", R"({"step": "10 kg"})",
          R"({"seed": -1})", R"({"seed": 1.5})", R"({"fidelity": "ful"})", R"({"signal": "15 s"})",
          R"({"signal": {"gren": "15 s"}})", R"({"vehicle": {"mass": "1 t"}})",
          R"({"vehicle": {"base": "x", "full_load": {"0 m": "90 N m"}}})", R"({"populations": []})",
          R"({"populations": [{"name": "A"}]})", R"({"measure": {"green": [5]}})",
          R"({"populations": [{"name": "A", "components": [{"policy": "CDG", "share": 0.5}]}]})"}) {
        EXPECT_NE(violation_of(bad), "") << bad;
    }
}

}  // namespace
}  // namespace stopline

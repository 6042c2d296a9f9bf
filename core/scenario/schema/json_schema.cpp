// Writes the tables of fields as a JSON schema (draft 07). Editors use it to complete and check scenario files.
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "base/nearest_name.h"
#include "scenario/load_scenario.h"
#include "scenario/schema/fields.h"
#include "scenario/schema/write_fields.h"

namespace stopline {
namespace {

using Json = nlohmann::ordered_json;

Json table_schema(const Table& table, const void* settings);

Json quantity_schema(const Unit& unit, const Range& range) {
    const Json text{{"type", "string"}, {"pattern", quantity_pattern(unit)}};
    if (!unit.text.empty()) return text;
    Json number{{"type", "number"}, {"minimum", to_si(range.min, unit)}};
    if (range.max != std::numeric_limits<double>::max()) number["maximum"] = to_si(range.max, unit);
    return Json{{"anyOf", Json::array({number, text})}};
}

void set_size(Json& schema, const Count& size, const char* minimum, const char* maximum) {
    schema[minimum] = size.min;
    if (size.max != std::numeric_limits<std::uint64_t>::max()) schema[maximum] = size.max;
}

// A YAML editor treats an unquoted name of digits as a number, so the schema allows numbers as names.
Json text_schema(TextField::Rule rule) {
    if (rule == TextField::Rule::title) return Json{{"type", "string"}, {"maxLength", 200}};
    return Json{{"type", {"string", "number"}}, {"pattern", "^[-A-Za-z0-9_.+]{1,64}$"}};
}

// Returns the schema of a field. There is one operator() for each kind of field.
struct KindSchema {
    const void* settings;

    Json operator()(const NumberField& f) const { return quantity_schema(*f.unit, f.range); }

    Json operator()(const WholeField& f) const {
        Json schema{{"type", "integer"}};
        set_size(schema, f.range, "minimum", "maximum");
        return schema;
    }

    Json operator()(const TextField& f) const { return text_schema(f.rule); }

    Json operator()(const TextsField& f) const {
        Json list{{"type", "array"}, {"items", text_schema(f.rule)}};
        set_size(list, f.size, "minItems", "maxItems");
        return Json{{"anyOf", Json::array({text_schema(f.rule), list})}};
    }

    Json operator()(const ChoiceField& f) const { return Json{{"enum", f.names}}; }

    Json operator()(const NumbersField& f) const {
        Json schema{{"type", "array"}, {"items", quantity_schema(*f.unit, f.range)}};
        set_size(schema, f.size, "minItems", "maxItems");
        return schema;
    }

    Json operator()(const CurveField& f) const {
        Json schema{{"type", "object"},
                    {"additionalProperties", false},
                    {"patternProperties", {{quantity_pattern(*f.x_unit), quantity_schema(*f.y_unit, f.y_range)}}}};
        set_size(schema, f.size, "minProperties", "maxProperties");
        return schema;
    }

    Json operator()(const SectionField& f) const {
        const std::shared_ptr<void> defaults = f.is_optional ? f.table().make_default() : nullptr;
        Json map = table_schema(f.table(), f.is_optional ? defaults.get() : f.read(settings));
        if (f.library.empty()) return map;
        const Json name{{"type", "string"},
                        {"description", "name of a file in data/" + f.library + ", or path of a file"}};
        Json based = map;
        based["properties"]["base"] = name;
        based["required"] = {"base"};
        return Json{{"anyOf", Json::array({name, based, map})}};
    }

    Json operator()(const ListField& f) const {
        Json item = table_schema(f.table(), f.table().make_default().get());
        if (f.table().expand != nullptr) item = Json{{"anyOf", Json::array({Json{{"type", "string"}}, item})}};
        Json schema{{"type", "array"}, {"items", item}};
        set_size(schema, f.count, "minItems", "maxItems");
        return schema;
    }
};

std::string description(const Field& field, const void* settings) {
    std::string text = field.meaning + " (" + allowed_text(field.kind);
    const std::string fallback = field.fallback.empty() ? value_text(field.kind, settings) : field.fallback;
    if (!field.required && !fallback.empty()) text += "; default " + fallback;
    if (!field.condition_field.empty())
        text += "; only if " + field.condition_field + " is " + joined(field.condition_values, " or ");
    return text + ")";
}

Json table_schema(const Table& table, const void* settings) {
    Json properties = Json::object();
    Json required = Json::array();
    for (const Field& field : table.fields) {
        Json schema = std::visit(KindSchema{settings}, field.kind);
        schema["description"] = description(field, settings);
        for (const std::string& old_name : field.old_names) {
            properties[old_name] = schema;
            properties[old_name]["description"] = "old name of '" + field.name + "'";
            properties[old_name]["deprecated"] = true;
        }
        properties[field.name] = std::move(schema);
        // The schema does not require a field with a condition, because the field does not exist if the condition is
        // false. The schema does not require a field with an old name either, because the file may use the old name.
        const bool always = field.condition_field.empty() && field.old_names.empty();
        if (field.required && always) required.push_back(field.name);
    }
    Json schema{{"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties)}};
    if (!required.empty()) schema["required"] = std::move(required);
    return schema;
}

}  // namespace

std::string json_schema() {
    const Scenario defaults;
    Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Stopline scenario"}};
    schema.update(table_schema(scenario_table(), &defaults));
    return schema.dump(2) + "\n";
}

}  // namespace stopline

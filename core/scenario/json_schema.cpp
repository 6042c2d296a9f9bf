// The table of fields as a JSON schema (draft 07): editors complete and check scenario files with it.
#include <nlohmann/json.hpp>
#include <string>

#include "scenario/fields.h"
#include "scenario/load_scenario.h"
#include "scenario/nearest_name.h"
#include "scenario/write_fields.h"

namespace stopline {
namespace {

using Json = nlohmann::ordered_json;

Json table_schema(const Table& table, const void* settings);

Json quantity_schema(const Unit& shown, const Range& range) {
    const Json text{{"type", "string"}, {"pattern", quantity_pattern(shown.dimension)}};
    if (shown.dimension != Dimension::number) return text;
    Json number{{"type", "number"}, {"minimum", to_si(range.min, shown)}};
    if (range.max != std::numeric_limits<double>::max()) number["maximum"] = to_si(range.max, shown);
    return Json{{"anyOf", Json::array({number, text})}};
}

void set_size(Json& schema, const Count& size, const char* minimum, const char* maximum) {
    schema[minimum] = size.min;
    if (size.max != std::numeric_limits<std::uint64_t>::max()) schema[maximum] = size.max;
}

// A text of digits alone is a number to a YAML editor.
Json text_schema(TextField::Rule rule) {
    if (rule == TextField::Rule::title) return Json{{"type", "string"}, {"maxLength", 200}};
    return Json{{"type", {"string", "number"}}, {"pattern", "^[-A-Za-z0-9_.+]{1,64}$"}};
}

struct KindSchema {
    const void* settings;

    Json operator()(const NumberField& f) const { return quantity_schema(*f.shown, f.range); }

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
        Json schema{{"type", "array"}, {"items", quantity_schema(*f.shown, f.range)}};
        set_size(schema, f.size, "minItems", "maxItems");
        return schema;
    }

    Json operator()(const CurveField& f) const {
        Json schema{
            {"type", "object"},
            {"additionalProperties", false},
            {"patternProperties", {{quantity_pattern(f.x_shown->dimension), quantity_schema(*f.y_shown, f.y_range)}}}};
        set_size(schema, f.size, "minProperties", "maxProperties");
        return schema;
    }

    Json operator()(const SectionField& f) const {
        Json map = table_schema(f.table(), f.read(settings));
        if (f.library.empty()) return map;
        const Json name{{"type", "string"}, {"description", "a file of data/" + f.library + ", or a path"}};
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
    if (!field.only_field.empty())
        text += "; only where " + field.only_field + " is " + joined(field.only_values, " or ");
    return text + ")";
}

Json table_schema(const Table& table, const void* settings) {
    Json properties = Json::object();
    Json required = Json::array();
    for (const Field& field : table.fields) {
        Json schema = std::visit(KindSchema{settings}, field.kind);
        schema["description"] = description(field, settings);
        properties[field.name] = std::move(schema);
        // A field that depends on a choice is not always there.
        if (field.required && field.only_field.empty()) required.push_back(field.name);
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

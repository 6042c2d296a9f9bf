#include "fuzz/catalogue.h"

#include <algorithm>
#include <string>

#include "scenario/schema/fields.h"
#include "scenario/visit_rows.h"

namespace stopline::fuzz {

namespace {

void remove_duplicates(std::vector<std::string>& words) {
    std::sort(words.begin(), words.end());
    words.erase(std::unique(words.begin(), words.end()), words.end());
}

// Adds the values that a field allows, and some at the ends of its range.
void add_values(const Field& field, std::vector<std::string>& values) {
    if (!field.fallback.empty()) values.push_back(field.fallback);
    for (const OldValue& old : field.old_values) values.push_back(old.old_name);
    if (const auto* const choice = std::get_if<ChoiceField>(&field.kind)) {
        values.insert(values.end(), choice->names.begin(), choice->names.end());
    } else if (const auto* const number = std::get_if<NumberField>(&field.kind)) {
        for (const double si : {number->range.min, number->range.max, 1.0}) {
            values.push_back(exact_text(to_si(si, *number->unit), *number->unit));
        }
    } else if (const auto* const whole = std::get_if<WholeField>(&field.kind)) {
        values.push_back(std::to_string(whole->range.min));
        values.push_back(std::to_string(whole->range.max));
    }
}

Catalogue make_catalogue() {
    Catalogue made;
    for (const Table* const root : {&scenario_table(), &sweep_table()}) {
        visit_rows(*root, "", [&](const Table& /*table*/, const Field& field, const std::string& path) {
            made.keys.push_back(field.name);
            made.keys.insert(made.keys.end(), field.old_names.begin(), field.old_names.end());
            std::string with_index = path;
            for (std::size_t k = 0; (k = with_index.find("[]", k)) != std::string::npos;) with_index.insert(k + 1, "0");
            made.paths.push_back(with_index);
            add_values(field, made.values);
        });
    }
    for (const Unit& unit : units()) {
        for (const char* const number : {"0 ", "1 ", "-1 ", "1e300 ", "0.1 ", "50 "}) {
            made.values.push_back(number + std::string(unit.text));
        }
    }
    for (const char* const unusual : {"", "~", "[]", "{}", "nan", "off", "*a", "&a x", "[*a, *a]", "\"\\e[31m\"",
                                      "18446744073709551615", "[1 s, 2 s]", "CTG-Ref", "../x.yaml", "a: b"}) {
        made.values.emplace_back(unusual);
    }
    remove_duplicates(made.keys);
    remove_duplicates(made.values);
    return made;
}

}  // namespace

const Catalogue& catalogue() {
    static const Catalogue kMade = make_catalogue();
    return kMade;
}

}  // namespace stopline::fuzz

// Makes the rows of a table of fields from pointers to struct members, see field_table.h.
#pragma once

#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "scenario/schema/field_table.h"

namespace stopline {

template <class S>
struct Row {
    Field field;

    Row required() && {
        field.required = true;
        return std::move(*this);
    }
    Row fallback(std::string yaml) && {
        field.fallback = std::move(yaml);
        return std::move(*this);
    }
    // Restricts the field to settings in which the choice `choice_field` has one of `values`, see
    // Field::condition_field.
    Row only_if(std::string choice_field, std::vector<std::string> values) && {
        field.condition_field = std::move(choice_field);
        field.condition_values = std::move(values);
        return std::move(*this);
    }
    // Makes the field a parameter of a traffic rule. The choice field `rule` switches the rule on and off. See
    // Field::is_rule_parameter.
    Row enabled_by(std::string rule) && {
        field.is_rule_parameter = true;
        return std::move(*this).only_if(std::move(rule), {"on"});
    }
    // Adds a name that the field had in the previous release, see old_names.h.
    Row renamed_from(std::string old_name) && {
        field.old_names.push_back(std::move(old_name));
        return std::move(*this);
    }
    // Adds a name that the choice value `name` had in the previous release.
    Row value_renamed(std::string old_name, std::string name) && {
        field.old_values.push_back({std::move(old_name), std::move(name)});
        return std::move(*this);
    }
};

namespace field_rows {

template <class M>
struct Member;
template <class S, class T>
struct Member<T S::*> {
    using Struct = S;
    using Type = T;
};
template <auto M>
using StructOf = typename Member<decltype(M)>::Struct;
template <auto M>
using TypeOf = typename Member<decltype(M)>::Type;

template <auto M>
Access<TypeOf<M>> access() {
    using S = StructOf<M>;
    return {[](void* s) -> TypeOf<M>& { return static_cast<S*>(s)->*M; },
            [](const void* s) -> const TypeOf<M>& { return static_cast<const S*>(s)->*M; }};
}

}  // namespace field_rows

template <auto M>
auto number(std::string name, std::string_view unit_name, Range range, std::string meaning) {
    return Row<field_rows::StructOf<M>>{
        {std::move(name), std::move(meaning), NumberField{field_rows::access<M>(), &unit(unit_name), range}}};
}

// Makes the row of the element `Index` of an array member.
template <auto M, std::size_t Index>
auto number_at(std::string name, std::string_view unit_name, Range range, std::string meaning) {
    using S = field_rows::StructOf<M>;
    const Access<double> access{[](void* s) -> double& { return (static_cast<S*>(s)->*M)[Index]; },
                                [](const void* s) -> const double& { return (static_cast<const S*>(s)->*M)[Index]; }};
    return Row<S>{{std::move(name), std::move(meaning), NumberField{access, &unit(unit_name), range}}};
}

template <auto M>
auto whole_number(std::string name, Count range, std::string meaning) {
    using S = field_rows::StructOf<M>;
    using T = field_rows::TypeOf<M>;
    static_assert(std::is_integral_v<T>);
    return Row<S>{
        {std::move(name), std::move(meaning),
         WholeField{[](const void* s) { return static_cast<std::uint64_t>(static_cast<const S*>(s)->*M); },
                    [](void* s, std::uint64_t value) { static_cast<S*>(s)->*M = static_cast<T>(value); },
                    {range.min, std::min(range.max, static_cast<std::uint64_t>(std::numeric_limits<T>::max()))}}}};
}

template <auto M>
auto text(std::string name, TextField::Rule rule, std::string meaning) {
    return Row<field_rows::StructOf<M>>{
        {std::move(name), std::move(meaning), TextField{field_rows::access<M>(), rule}}};
}

template <auto M>
auto texts(std::string name, TextField::Rule rule, Count size, std::string meaning) {
    return Row<field_rows::StructOf<M>>{
        {std::move(name), std::move(meaning), TextsField{field_rows::access<M>(), rule, size}}};
}

// Makes the row of a choice from a string member. `names` are the allowed values.
template <auto M>
auto choice(std::string name, std::vector<std::string> names, std::string meaning) {
    using S = field_rows::StructOf<M>;
    return Row<S>{{std::move(name), std::move(meaning),
                   ChoiceField{std::move(names), [](const void* s) { return static_cast<const S*>(s)->*M; },
                               [](void* s, const std::string& value) { static_cast<S*>(s)->*M = value; }}}};
}

// Makes the row of a choice from an enumeration member. `names` are the names of the enumerators 0, 1, 2 and so on.
template <auto M>
auto enumeration(std::string name, const std::vector<std::string>& names, std::string meaning) {
    using S = field_rows::StructOf<M>;
    using T = field_rows::TypeOf<M>;
    static_assert(std::is_enum_v<T>);
    auto get = [names](const void* s) { return names.at(static_cast<std::size_t>(static_cast<const S*>(s)->*M)); };
    auto set = [names](void* s, const std::string& value) {
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (names[i] == value) static_cast<S*>(s)->*M = static_cast<T>(i);
        }
    };
    return Row<S>{{std::move(name), std::move(meaning), ChoiceField{names, get, set}}};
}

template <auto M>
auto numbers(std::string name, std::string_view unit_name, Range range, Count size, std::string meaning,
             bool rising = false) {
    return Row<field_rows::StructOf<M>>{{std::move(name), std::move(meaning),
                                         NumbersField{field_rows::access<M>(), &unit(unit_name), range, size, rising}}};
}

struct CurveAxis {
    std::string_view unit;
    Range range;
};

// Makes the row of a curve from two vector members, one for x and one for y.
template <auto X, auto Y>
auto curve(std::string name, CurveAxis x, CurveAxis y, Count size, std::string meaning) {
    static_assert(std::is_same_v<field_rows::StructOf<X>, field_rows::StructOf<Y>>);
    return Row<field_rows::StructOf<X>>{{std::move(name), std::move(meaning),
                                         CurveField{field_rows::access<X>(), field_rows::access<Y>(), &unit(x.unit),
                                                    x.range, &unit(y.unit), y.range, size}}};
}

// Makes the row of a curve from one member that is a struct with the vectors x and y.
template <auto M>
auto curve(std::string name, CurveAxis x, CurveAxis y, Count size, std::string meaning) {
    using S = field_rows::StructOf<M>;
    const Access<std::vector<double>> at_x{
        [](void* s) -> std::vector<double>& { return (static_cast<S*>(s)->*M).x; },
        [](const void* s) -> const std::vector<double>& { return (static_cast<const S*>(s)->*M).x; }};
    const Access<std::vector<double>> at_y{
        [](void* s) -> std::vector<double>& { return (static_cast<S*>(s)->*M).y; },
        [](const void* s) -> const std::vector<double>& { return (static_cast<const S*>(s)->*M).y; }};
    return Row<S>{{std::move(name), std::move(meaning),
                   CurveField{at_x, at_y, &unit(x.unit), x.range, &unit(y.unit), y.range, size}}};
}

template <auto M>
auto section(std::string name, const Table& (*table)(), std::string meaning, std::string library = {}) {
    using S = field_rows::StructOf<M>;
    return Row<S>{{std::move(name), std::move(meaning),
                   SectionField{[](void* s) -> void* { return &(static_cast<S*>(s)->*M); },
                                [](const void* s) -> const void* { return &(static_cast<const S*>(s)->*M); }, table,
                                std::move(library)}}};
}

// Makes the row of a section that can be absent. The member is a std::optional.
template <auto M>
auto optional_section(std::string name, const Table& (*table)(), std::string meaning, std::string library = {}) {
    using S = field_rows::StructOf<M>;
    return Row<S>{{std::move(name), std::move(meaning),
                   SectionField{[](void* s) -> void* { return &(static_cast<S*>(s)->*M).emplace(); },
                                [](const void* s) -> const void* {
                                    const auto& member = static_cast<const S*>(s)->*M;
                                    return member.has_value() ? &*member : nullptr;
                                },
                                table, std::move(library), true}}};
}

template <auto M>
auto list(std::string name, const Table& (*table)(), Count count, std::string meaning, std::string library = {}) {
    using S = field_rows::StructOf<M>;
    return Row<S>{
        {std::move(name), std::move(meaning),
         ListField{[](const void* s) { return (static_cast<const S*>(s)->*M).size(); },
                   [](const void* s, std::size_t i) -> const void* { return &(static_cast<const S*>(s)->*M).at(i); },
                   [](void* s) -> void* { return &(static_cast<S*>(s)->*M).emplace_back(); }, table, count,
                   std::move(library)}}};
}

template <class S>
Table make_table(std::string title, const std::vector<Row<S>>& rows, void (*check)(const S&, Checker&) = nullptr,
                 SourceNode (*expand)(const SourceNode&) = nullptr) {
    Table table;
    table.title = std::move(title);
    for (const Row<S>& row : rows) table.fields.push_back(row.field);
    table.make_default = []() -> std::shared_ptr<void> { return std::make_shared<S>(); };
    if (check != nullptr) {
        table.check = [check](const void* s, Checker& checker) { check(*static_cast<const S*>(s), checker); };
    }
    table.expand = expand;
    return table;
}

}  // namespace stopline

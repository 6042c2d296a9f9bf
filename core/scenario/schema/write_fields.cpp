#include "scenario/schema/write_fields.h"

namespace stopline {
namespace {

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return result + "\"";
}

// Returns the YAML text of a value, to be appended to "name:". The text begins with a space or a line break.
struct ValueWriter {
    const void* settings;
    int indent;  // number of spaces before the further lines of the value

    std::string margin() const { return std::string(static_cast<std::size_t>(indent), ' '); }

    std::string operator()(const NumberField& f) const { return " " + exact_text(f.at.read(settings), *f.unit) + "\n"; }
    std::string operator()(const WholeField& f) const { return " " + std::to_string(f.get(settings)) + "\n"; }
    std::string operator()(const TextField& f) const { return " " + quoted(f.at.read(settings)) + "\n"; }
    std::string operator()(const TextsField& f) const {
        std::string line;
        for (const std::string& value : f.at.read(settings)) line += (line.empty() ? "" : ", ") + quoted(value);
        return " [" + line + "]\n";
    }
    std::string operator()(const ChoiceField& f) const { return " " + f.get(settings) + "\n"; }

    std::string operator()(const NumbersField& f) const {
        std::string line;
        for (const double value : f.at.read(settings)) line += (line.empty() ? "" : ", ") + exact_text(value, *f.unit);
        return " [" + line + "]\n";
    }

    std::string operator()(const CurveField& f) const {
        const std::vector<double>& x = f.x.read(settings);
        const std::vector<double>& y = f.y.read(settings);
        std::string lines = "\n";
        for (std::size_t i = 0; i < x.size() && i < y.size(); ++i) {
            lines += margin() + exact_text(x[i], *f.x_unit) + ": " + exact_text(y[i], *f.y_unit) + "\n";
        }
        return x.empty() ? " {}\n" : lines;
    }

    std::string operator()(const SectionField& f) const {
        return "\n" + write_fields(f.table(), f.read(settings), indent);
    }

    std::string operator()(const ListField& f) const {
        if (f.size(settings) == 0) return " []\n";
        std::string lines = "\n";
        for (std::size_t i = 0; i < f.size(settings); ++i) {
            std::string item = write_fields(f.table(), f.item(settings, i), indent + 2);
            item[static_cast<std::size_t>(indent)] = '-';
            lines += item;
        }
        return lines;
    }
};

// Returns true for an empty text and for an absent section. write_fields() leaves out such a field.
bool is_absent(const FieldKind& kind, const void* settings) {
    const auto* const section = std::get_if<SectionField>(&kind);
    if (section != nullptr) return section->read(settings) == nullptr;
    const auto* const text = std::get_if<TextField>(&kind);
    return text != nullptr && text->at.read(settings).empty();
}

struct ValueText {
    const void* settings;

    std::string operator()(const NumberField& f) const { return short_text(f.at.read(settings), *f.unit); }
    std::string operator()(const WholeField& f) const { return std::to_string(f.get(settings)); }
    std::string operator()(const TextField& f) const { return f.at.read(settings); }
    std::string operator()(const ChoiceField& f) const { return f.get(settings); }
    std::string operator()(const NumbersField& f) const {
        std::string line;
        for (const double value : f.at.read(settings)) line += (line.empty() ? "" : ", ") + short_text(value, *f.unit);
        return "[" + line + "]";
    }
    template <class Nested>
    std::string operator()(const Nested& /*nested*/) const {
        return {};
    }
};

}  // namespace

std::string write_fields(const Table& table, const void* settings, int indent) {
    std::string lines;
    for (const Field& field : table.fields) {
        if (!applies(table, field, settings) || is_absent(field.kind, settings)) continue;
        lines += std::string(static_cast<std::size_t>(indent), ' ') + field.name + ":";
        lines += std::visit(ValueWriter{settings, indent + 2}, field.kind);
    }
    return lines;
}

std::string value_text(const FieldKind& kind, const void* settings) { return std::visit(ValueText{settings}, kind); }

}  // namespace stopline

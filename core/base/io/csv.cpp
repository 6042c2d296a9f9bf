#include "base/io/csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/input_error.h"

namespace stopline {

namespace {

// Reads the records of a CSV text. The reader does not split the text into lines first, because a quoted field can
// contain line breaks.
class CsvReader {
public:
    CsvReader(std::string_view text, const std::string& label) : text_(text), label_(label) {}

    bool at_end() const { return next_ >= text_.size(); }
    int line() const { return line_; }

    std::vector<std::string> read_record() {
        std::vector<std::string> fields{read_field()};
        while (!at_end() && text_[next_] == ',') {
            ++next_;
            fields.push_back(read_field());
        }
        if (!at_end() && text_[next_] == '\r') ++next_;
        if (!at_end()) ++next_;  // skips the line break
        ++line_;
        return fields;
    }

private:
    std::string read_field() {
        if (at_end() || text_[next_] != '"') {
            const std::size_t end = std::min(text_.find_first_of(",\r\n", next_), text_.size());
            const std::size_t begin = std::exchange(next_, end);
            return std::string(text_.substr(begin, end - begin));
        }
        const int opening_line = line_;
        std::string value;
        for (++next_; !at_end(); ++next_) {
            if (text_[next_] == '\n') ++line_;
            if (text_[next_] == '"') {
                ++next_;
                if (at_end() || text_[next_] != '"') return value;
            }
            value += text_[next_];
        }
        throw InputError(fmt::format("{}:{}: the quote that opens here is never closed", label_, opening_line));
    }

    std::string_view text_;
    const std::string& label_;
    std::size_t next_ = 0;
    int line_ = 1;
};

}  // namespace

std::string csv_field(const std::string& field) {
    if (field.find_first_of(",\"\r\n") == std::string::npos) return field;
    std::string text = "\"";
    for (const char c : field) text += c == '"' ? std::string("\"\"") : std::string(1, c);
    return text + '"';
}

void CsvWriter::row(const std::vector<std::string>& fields) {
    if (fields.size() != columns_) throw std::logic_error("a CSV row has not as many fields as the table has columns");
    for (std::size_t k = 0; k < fields.size(); ++k) text_ += (k == 0 ? "" : ",") + csv_field(fields[k]);
    text_ += '\n';
}

std::string fixed(double number, int decimals) {
    if (std::isnan(number)) return "";
    std::string text = fmt::format("{:.{}f}", number, decimals);
    if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
    return text;
}

std::size_t CsvTable::column(std::string_view name) const {
    const auto found = std::find(columns.begin(), columns.end(), name);
    if (found == columns.end()) {
        throw InputError(
            fmt::format("{}: there is no column '{}'; the columns are {}", label, name, fmt::join(columns, ", ")));
    }
    return static_cast<std::size_t>(found - columns.begin());
}

CsvTable parse_csv(std::string_view text, const std::string& label) {
    CsvTable table;
    table.label = label;
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // spreadsheets write it at the start of UTF-8 files
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    CsvReader reader(text, label);
    if (reader.at_end()) throw InputError(fmt::format("{}: the file is empty", label));
    table.columns = reader.read_record();
    if (table.columns.size() == 1 && table.columns.front().find(';') != std::string::npos) {
        throw InputError(fmt::format(
            "{}:1: semicolons separate the columns: use commas instead, and decimal points in numbers", label));
    }
    while (!reader.at_end()) {
        const int line = reader.line();
        std::vector<std::string> fields = reader.read_record();
        if (fields.size() == 1 && fields.front().empty()) continue;  // skips an empty line
        if (fields.size() != table.columns.size()) {
            throw InputError(fmt::format("{}:{}: the number of fields is {}, but the header has {} columns", label,
                                         line, fields.size(), table.columns.size()));
        }
        table.rows.push_back(std::move(fields));
        table.lines.push_back(line);
    }
    return table;
}

std::optional<double> parse_number(const std::string& text) {
    double number = 0.0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || stop != end || !std::isfinite(number)) return std::nullopt;
    return number;
}

}  // namespace stopline

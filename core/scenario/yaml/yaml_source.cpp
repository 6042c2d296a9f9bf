#include "scenario/yaml/yaml_source.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/io/printable.h"
#include "base/nearest_name.h"

namespace stopline {
namespace {

[[noreturn]] void fail(const Place& place, const std::string& message) { throw YamlError(place, message); }

// A text with the start of each of its lines.
class Lines {
public:
    explicit Lines(std::string_view text) : text_(text) {
        for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n', end + 1)) {
            starts_.push_back(end + 1);
        }
    }

    std::string_view text() const { return text_; }

    // Returns the index of a character. yaml-cpp does not count the byte order mark in the first line.
    std::size_t index(const YAML::Mark& mark) const {
        constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
        const auto line = std::min(static_cast<std::size_t>(mark.line), starts_.size() - 1);
        const std::size_t before = line == 0 && text_.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
        return std::min(starts_[line] + before + static_cast<std::size_t>(mark.column), text_.size());
    }

    // Returns true if one of the blanks at the start of the line is a tab.
    bool begins_with_tab(const YAML::Mark& mark) const {
        YAML::Mark start = mark;
        start.column = 0;
        const std::string_view line = text_.substr(index(start));
        return line.substr(0, line.find_first_not_of(" \t")).find('\t') != std::string_view::npos;
    }

private:
    std::string_view text_;
    std::vector<std::size_t> starts_{0};
};

// Returns the length of a text in quotes, with both quotes. `text` begins with the opening quote. Returns npos if the
// closing quote is missing.
std::size_t quoted_length(std::string_view text) {
    const char quote = text.front();
    for (std::size_t i = 1; i < text.size(); ++i) {
        const bool is_doubled = quote == '\'' && text.substr(i).starts_with("''");
        const bool is_escaped = quote == '"' && text[i] == '\\';
        if (is_doubled || is_escaped) {
            ++i;
        } else if (text[i] == quote) {
            return i + 1;
        }
    }
    return std::string_view::npos;
}

// Builds the tree of nodes from the events of the yaml-cpp parser.
class TreeBuilder : public YAML::EventHandler {
public:
    TreeBuilder(std::shared_ptr<const Source> source, const Lines& lines) : source_(std::move(source)), lines_(lines) {}

    SourceNode take_root() { return std::move(root_); }

    // Returns a hint if the parser stopped right behind a text in quotes that has several lines. Such a text probably
    // lacks its own closing quote and ends at the opening quote of another text.
    std::string hint_of_long_quote(const YAML::Mark& error) const {
        const std::size_t index = lines_.index(error);
        if (quote_end_ == 0 || quote_end_ > index || quote_begin_.line >= error.line) return {};
        const std::string_view between = lines_.text().substr(quote_end_, index - quote_end_);
        if (between.find_first_not_of(" \t\r\n") != std::string_view::npos) return {};
        return ". The text in quotes before this place begins in line " + std::to_string(quote_begin_.line + 1) +
               ", column " + std::to_string(quote_begin_.column + 1) + ": is its closing quote missing there?";
    }

    void OnDocumentStart(const YAML::Mark& mark) override {
        if (++documents_ > 1)
            fail(at(mark), "a second YAML document ('---') starts here; only one per file is allowed");
    }
    void OnDocumentEnd() override {}

    void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        put(make(SourceNode::Kind::empty, mark), anchor);
    }

    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  const std::string& value) override {
        refuse_tag(tag, mark);
        quote_end_ = 0;
        if (tag == kQuotedTag) check_closing_quote(mark);
        // An escape sequence such as "\e" in a quoted text gives a control character.
        if (has_control_characters(value)) fail(at(mark), "the value has a control character");
        count_text(value.size(), mark);
        SourceNode node = make(SourceNode::Kind::scalar, mark);
        node.text = value;
        put(std::move(node), anchor);
    }

    void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        const auto found = anchors_.find(anchor);
        if (found == anchors_.end()) fail(at(mark), "this alias lies inside its own anchor: it would never end");
        count(found->second.nodes, mark);
        count_text(found->second.text_bytes, mark);
        SourceNode copy = found->second.tree;
        if (open_.size() + found->second.depth > kYamlDepthMax) fail_depth(mark);
        deepen(found->second.depth);
        put(std::move(copy), 0);
    }

    void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value /*style*/) override {
        open(SourceNode::Kind::list, mark, tag, anchor);
    }
    void OnSequenceEnd() override { close(); }

    void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value /*style*/) override {
        open(SourceNode::Kind::map, mark, tag, anchor);
    }
    void OnMapEnd() override { close(); }

private:
    struct Open {
        SourceNode node;
        YAML::anchor_t anchor = 0;
        std::size_t nodes_before = 0;
        std::size_t text_bytes_before = 0;
        std::size_t depth = 0;  // number of nesting levels from this container down to its deepest content so far
        std::unordered_set<std::string> keys;
        bool has_key = false;  // true: the last key of the map has no value yet
    };
    struct Anchored {
        SourceNode tree;
        std::size_t nodes = 0;
        std::size_t text_bytes = 0;
        std::size_t depth = 0;
    };

    Place at(const YAML::Mark& mark) const { return {source_, mark.line + 1, mark.column + 1}; }

    [[noreturn]] void fail_depth(const YAML::Mark& mark) const {
        fail(at(mark), "nested more than " + std::to_string(kYamlDepthMax) + " levels deep");
    }

    void refuse_tag(const std::string& tag, const YAML::Mark& mark) const {
        // yaml-cpp gives plain scalars the tag "?".
        if (!tag.empty() && tag != "?" && tag != kQuotedTag)
            fail(at(mark), "the YAML tag '" + tag + "' is not supported");
    }

    // Throws YamlError if a text in quotes has no closing quote. yaml-cpp 0.7 takes the rest of the file as its content
    // if the file ends with a line break.
    void check_closing_quote(YAML::Mark mark) {
        // An anchor or the tag `!` can precede the text.
        const std::size_t begin = lines_.index(mark);
        std::string_view rest = lines_.text().substr(begin);
        while (rest.starts_with('&') || rest.starts_with('!')) {
            rest.remove_prefix(std::min(rest.find_first_of(" \t\n"), rest.size()));
            rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
        }
        if (!rest.starts_with('"') && !rest.starts_with('\'')) return;
        const std::size_t skipped = lines_.text().size() - rest.size() - begin;
        mark.column += static_cast<int>(skipped);
        const std::size_t length = quoted_length(rest);
        if (length == std::string_view::npos) {
            fail(at(mark), std::string("this text begins with the quote ") + rest.front() +
                               " but has no closing quote: add the quote at the end of the text");
        }
        quote_begin_ = mark;
        quote_end_ = begin + skipped + length;
    }

    void count(std::size_t nodes, const YAML::Mark& mark) {
        nodes_ += nodes;
        if (nodes_ > kYamlNodesMax) {
            fail(at(mark), "more than " + std::to_string(kYamlNodesMax) + " values (aliases written out)");
        }
    }

    void count_text(std::size_t bytes, const YAML::Mark& mark) {
        text_bytes_ += bytes;
        if (text_bytes_ > kYamlTextMax) fail(at(mark), "the values are longer than 16 MB (aliases written out)");
    }

    // Keeps a copy of an anchored node for its aliases.
    void keep(YAML::anchor_t anchor, Anchored node) {
        kept_nodes_ += node.nodes;
        kept_bytes_ += node.text_bytes;
        if (kept_nodes_ > kYamlNodesMax || kept_bytes_ > kYamlTextMax) {
            fail(node.tree.place, "the anchors contain too many values");
        }
        anchors_[anchor] = std::move(node);
    }

    SourceNode make(SourceNode::Kind kind, const YAML::Mark& mark) {
        count(1, mark);
        SourceNode node;
        node.kind = kind;
        node.place = at(mark);
        return node;
    }

    void open(SourceNode::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
        refuse_tag(tag, mark);
        if (open_.size() >= kYamlDepthMax) fail_depth(mark);
        const std::size_t before = nodes_;
        open_.push_back(Open{make(kind, mark), anchor, before, text_bytes_, 1, {}, false});
    }

    void close() {
        Open closed = std::move(open_.back());
        open_.pop_back();
        deepen(closed.depth);
        if (closed.anchor != 0) {
            keep(closed.anchor, Anchored{closed.node, nodes_ - closed.nodes_before,
                                         text_bytes_ - closed.text_bytes_before, closed.depth});
        }
        put(std::move(closed.node), 0);
    }

    // Records that a node with `levels` nesting levels has been added to the innermost open container.
    void deepen(std::size_t levels) {
        if (!open_.empty()) open_.back().depth = std::max(open_.back().depth, levels + 1);
    }

    // Adds a finished node to the innermost open container as a key, a value or a list item.
    void put(SourceNode node, YAML::anchor_t anchor) {
        if (anchor != 0) keep(anchor, Anchored{node, 1, node.text.size(), 0});
        if (open_.empty()) {
            root_ = std::move(node);
            return;
        }
        Open& parent = open_.back();
        if (parent.node.kind == SourceNode::Kind::list) {
            parent.node.items.push_back(std::move(node));
        } else if (parent.has_key) {
            // For a missing value the parser gives the position of the next token, which can be some lines below. The
            // position of the key is more useful.
            if (node.kind == SourceNode::Kind::empty) node.place = parent.node.keys.back().place;
            parent.node.items.push_back(std::move(node));
            parent.has_key = false;
        } else {
            put_key(parent, node);
        }
    }

    static void put_key(Open& map, const SourceNode& key) {
        if (key.kind != SourceNode::Kind::scalar) fail(key.place, "a key must be a plain text");
        if (key.text == "<<") fail(key.place, "the merge key '<<' is not supported");
        if (!map.keys.insert(key.text).second) fail(key.place, "the key '" + key.text + "' appears twice");
        map.node.keys.push_back({key.text, key.place});
        map.has_key = true;
    }

    static constexpr const char* kQuotedTag = "!";  // yaml-cpp's tag of scalars in quotes

    std::shared_ptr<const Source> source_;
    const Lines& lines_;
    SourceNode root_;
    std::vector<Open> open_;
    std::map<YAML::anchor_t, Anchored> anchors_;
    std::size_t nodes_ = 0;
    std::size_t text_bytes_ = 0;
    std::size_t kept_nodes_ = 0;  // in anchors_
    std::size_t kept_bytes_ = 0;  // of text in anchors_
    int documents_ = 0;
    YAML::Mark quote_begin_;     // of the latest scalar, if it is a text in quotes
    std::size_t quote_end_ = 0;  // index behind its closing quote; 0: the latest scalar has no quotes
};

void require_text(std::string_view text, const std::shared_ptr<const Source>& source) {
    Place place{source, 1, 1};
    for (std::size_t i = 0; i < text.size();) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const std::size_t length = utf8_length(text, i);
        const bool control = (byte < 0x20 && byte != '\n' && byte != '\r' && byte != '\t') || byte == 0x7F;
        if (length == 0 || control) {
            std::array<char, 8> hex{};
            static_cast<void>(std::snprintf(hex.data(), hex.size(), "0x%02X", unsigned{byte}));
            fail(place, std::string("not a YAML text in UTF-8 (byte ") + hex.data() + ")");
        }
        i += length;
        ++place.column;
        if (byte == '\n') {
            ++place.line;
            place.column = 1;
        }
    }
}

// Counts open brackets before the parser runs, because yaml-cpp reads ahead to the end of a list or map in brackets and
// needs much memory for each open one. Brackets in quotes and comments count, too. So the limit is far above the depth.
void refuse_many_open_brackets(std::string_view text, const std::shared_ptr<const Source>& source) {
    Place place{source, 1, 0};
    std::size_t open = 0;
    for (const char c : text) {
        ++place.column;
        if (c == '\n') {
            ++place.line;
            place.column = 0;
        }
        if (c == '[' || c == '{') ++open;
        if ((c == ']' || c == '}') && open > 0) --open;
        if (open > kYamlOpenBracketsMax) {
            fail(place, "more than " + std::to_string(kYamlOpenBracketsMax) +
                            " brackets are open here (those in comments and quotes count too)");
        }
    }
}

// Returns the usual causes of an error of the YAML parser, as the end of a message. Returns "" if the error explains
// itself.
std::string usual_causes(const YAML::Exception& error, const Lines& lines) {
    const auto is = [&](const char* problem) { return error.msg == problem; };
    using namespace YAML::ErrorMsg;
    if (is(END_OF_MAP_FLOW)) return ": a closing '}' is missing";
    if (is(END_OF_SEQ_FLOW)) return ": a closing ']' is missing";
    if (is(DOC_IN_SCALAR)) return ": a closing quote is missing before this place";
    if (is(UNKNOWN_TOKEN)) return ": a text that begins with this sign needs quotes";
    const bool is_layout = is(MAP_VALUE) || is(MAP_KEY) || is(BLOCK_ENTRY) || is(END_OF_MAP) || is(END_OF_SEQ);
    if (!is_layout && !is(TAB_IN_INDENTATION)) return {};
    if (!error.mark.is_null() && lines.begins_with_tab(error.mark)) return ": the line begins with a tab; use spaces";
    return ". Usual causes: a line that does not begin in the same column as the other fields of its section; a tab at "
           "the start of a line; a ': ' in a text without quotes (write it as title: \"a: b\")";
}

std::string size_text(std::uintmax_t bytes) {
    std::ostringstream text;
    text.precision(1);
    text << std::fixed << static_cast<double>(bytes) / (1u << 20u) << " MB";
    return text.str();
}

}  // namespace

SourceNode parse_yaml(std::string_view text, const std::shared_ptr<const Source>& source) {
    const Place start{source, 1, 1};
    if (text.size() > kYamlBytesMax) {
        fail(start, "has " + size_text(text.size()) + "; at most " + size_text(kYamlBytesMax) + " are read");
    }
    require_text(text, source);
    refuse_many_open_brackets(text, source);
    const Lines lines(text);
    TreeBuilder builder(source, lines);
    try {
        std::istringstream stream{std::string(text)};
        YAML::Parser parser(stream);
        while (parser.HandleNextDocument(builder)) {
        }
    } catch (const YAML::Exception& error) {
        // With a line break at its end, yaml-cpp reads the text, and TreeBuilder finds the position of the quote.
        if (error.msg == YAML::ErrorMsg::EOF_IN_SCALAR && !text.ends_with('\n')) {
            return parse_yaml(std::string(text) + "\n", source);
        }
        const Place place{source, error.mark.line + 1, error.mark.column + 1};
        const std::string hint = builder.hint_of_long_quote(error.mark);
        fail(error.mark.is_null() ? start : place,
             "not valid YAML: " + error.msg + (hint.empty() ? usual_causes(error, lines) : hint));
    }
    SourceNode root = builder.take_root();
    if (!root.place.source) root.place = start;
    return root;
}

std::string nearest_file_hint(const std::filesystem::path& file) {
    std::vector<std::string> names;
    std::error_code error;
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        if (entry.path().extension() == ".yaml") names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    const std::string nearest = nearest_name(file.filename().string(), names);
    if (nearest.empty()) return {};
    return "; did you mean '" + (file.parent_path() / nearest).generic_string() + "'?";
}

SourceNode read_yaml_file(const std::filesystem::path& file) {
    const std::string label = file.generic_string();
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found)
        throw InputError(label + ": no such file" + nearest_file_hint(file));
    if (std::filesystem::is_directory(status)) throw InputError(label + ": is a directory, not a YAML file");
    if (error || !std::filesystem::is_regular_file(status))
        throw InputError(label + ": is not a file that can be read");

    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (!error && size > kYamlBytesMax) {
        throw InputError(label + ": has " + size_text(size) + "; at most " + size_text(kYamlBytesMax) + " are read");
    }
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError(label + ": cannot be opened (no permission?)");
    std::string text(static_cast<std::size_t>(error ? 0 : size), '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!stream) throw InputError(label + ": cannot be read to its end");
    return parse_yaml(text, std::make_shared<Source>(Source{label, file.parent_path()}));
}

}  // namespace stopline

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

namespace stopline {
namespace {

[[noreturn]] void fail(const Place& place, const std::string& message) { throw YamlError(place, message); }

// Builds the tree of nodes from the events of the yaml-cpp parser.
class TreeBuilder : public YAML::EventHandler {
public:
    explicit TreeBuilder(std::shared_ptr<const Source> source) : source_(std::move(source)) {}

    SourceNode take_root() { return std::move(root_); }

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
        // yaml-cpp gives plain scalars the tag "?" and quoted scalars the tag "!".
        if (!tag.empty() && tag != "?" && tag != "!") fail(at(mark), "the YAML tag '" + tag + "' is not supported");
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

    std::shared_ptr<const Source> source_;
    SourceNode root_;
    std::vector<Open> open_;
    std::map<YAML::anchor_t, Anchored> anchors_;
    std::size_t nodes_ = 0;
    std::size_t text_bytes_ = 0;
    std::size_t kept_nodes_ = 0;  // in anchors_
    std::size_t kept_bytes_ = 0;  // of text in anchors_
    int documents_ = 0;
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
    TreeBuilder builder(source);
    try {
        std::istringstream stream{std::string(text)};
        YAML::Parser parser(stream);
        while (parser.HandleNextDocument(builder)) {
        }
    } catch (const YAML::Exception& error) {
        const Place place{source, error.mark.line + 1, error.mark.column + 1};
        fail(error.mark.is_null() ? start : place, "not valid YAML: " + error.msg);
    }
    SourceNode root = builder.take_root();
    if (!root.place.source) root.place = start;
    return root;
}

SourceNode read_yaml_file(const std::filesystem::path& file) {
    const std::string label = file.generic_string();
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found) throw InputError(label + ": no such file");
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

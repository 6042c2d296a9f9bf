#include "scenario/yaml/yaml_source.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>

#include "scenario/scenario_text.h"

namespace stopline {
namespace {

SourceNode parse(std::string_view text) { return parse_yaml(text, std::make_shared<Source>(Source{"test.yaml", "."})); }

std::string refusal(std::string_view text) {
    return input_error_of([&] { parse(text); });
}

TEST(YamlSource, KnowsThePlaceOfEveryValue) {
    const SourceNode root = parse("# comment\na: 1 s\nb:\n  c: [x, \"y z\"]\n");
    ASSERT_EQ(root.kind, SourceNode::Kind::map);
    ASSERT_EQ(root.keys.size(), 2u);
    EXPECT_EQ(to_string(root.keys[0].place), "test.yaml:2:1");
    EXPECT_EQ(to_string(root.find("a")->place), "test.yaml:2:4");
    EXPECT_EQ(root.find("a")->text, "1 s");
    const SourceNode* const list = root.find("b")->find("c");
    ASSERT_NE(list, nullptr);
    EXPECT_EQ(to_string(list->place), "test.yaml:4:6");
    EXPECT_EQ(to_string(list->items[1].place), "test.yaml:4:10");
    EXPECT_EQ(list->items[1].text, "y z");
    EXPECT_EQ(root.find("missing"), nullptr);
}

TEST(YamlSource, ExpandsAliases) {
    const SourceNode root = parse("a: &x {k: v}\nb: *x\nc: &y s\nd: *y\n");
    ASSERT_EQ(root.find("b")->kind, SourceNode::Kind::map);
    EXPECT_EQ(root.find("b")->find("k")->text, "v");
    EXPECT_EQ(root.find("d")->text, "s");
}

TEST(YamlSource, RefusesUnsupportedYaml) {
    EXPECT_TRUE(contains(refusal("a: 1\nb: 2\na: 3\n"), "test.yaml:3:1: the key 'a' appears twice"));
    EXPECT_TRUE(contains(refusal("a: 1\n---\nb: 2\n"), "a second YAML document"));
    EXPECT_TRUE(contains(refusal("[1, 2]: 3\n"), "test.yaml:1:1: a key must be a plain text"));
    EXPECT_TRUE(contains(refusal("~: 3\n"), "a key must be a plain text"));
    EXPECT_TRUE(contains(refusal("a: !!python/object x\n"), "is not supported"));
    EXPECT_TRUE(contains(refusal("a: !mine {x: 1}\n"), "is not supported"));
    EXPECT_TRUE(contains(refusal("a: &b {x: 1}\nc: {<<: *b}\n"), "merge key"));
    EXPECT_TRUE(contains(refusal("a: [1, 2\n"), "not valid YAML"));
    EXPECT_TRUE(contains(refusal("a: *nothing\n"), "not valid YAML"));
    EXPECT_TRUE(contains(refusal("a: b: c\n"), "test.yaml:1:5: not valid YAML"));
    EXPECT_TRUE(contains(refusal("\ta: 1\n"), "not valid YAML"));
}

// yaml-cpp reads such a text up to the end of the file, so that the fields below it would be lost.
TEST(YamlSource, RefusesQuotesWithoutEnd) {
    const std::string double_quote = "this text begins with the quote \" but has no closing quote";
    const std::string single_quote = "this text begins with the quote ' but has no closing quote";
    for (const char* end : {"", "\n", "\n\n\n", "\n   ", "\r\n"}) {
        EXPECT_TRUE(contains(refusal(std::string("title: \"abc\nseed: 5") + end), "test.yaml:1:8: " + double_quote));
        EXPECT_TRUE(contains(refusal(std::string("a: 1\ntitle: 'abc\nb: 5") + end), "test.yaml:2:8: " + single_quote));
    }
    EXPECT_TRUE(contains(refusal("a:\n- x\n- 'y\nb: 1\n"), "test.yaml:3:3: " + single_quote));
    EXPECT_TRUE(contains(refusal("a: {t: \"abc}\nb: 1\n"), "test.yaml:1:8: " + double_quote));
    EXPECT_TRUE(contains(refusal("a: [x, 'abc]\nb: 2\n"), "test.yaml:1:8: " + single_quote));
    EXPECT_TRUE(contains(refusal("a: 1\n\"b: 2\nc: 3\n"), "test.yaml:2:1: " + double_quote));
    EXPECT_TRUE(contains(refusal("a: &x \"abc\nb: *x\n"), "test.yaml:1:7: " + double_quote));
    EXPECT_TRUE(contains(refusal("a: \"x\\\"\nb: 1\n"), "test.yaml:1:4: " + double_quote));
    EXPECT_TRUE(contains(refusal("a: 'x''\nb: 1\n"), "test.yaml:1:4: " + single_quote));
    EXPECT_TRUE(contains(refusal("\xef\xbb\xbf\"a: 1\n"), "test.yaml:1:1: " + double_quote));
    EXPECT_TRUE(contains(refusal("a: \"x\nb: 1\nc: \"y\"\n"),
                         "The text in quotes before this place begins in line 1, column 4: is its closing quote"));
}

TEST(YamlSource, AcceptsTextsWithQuotes) {
    EXPECT_EQ(parse("a: it's \"so\"\n").find("a")->text, "it's \"so\"");
    EXPECT_EQ(parse("a: 'it''s'  # don't\nb: 1\n").find("a")->text, "it's");
    EXPECT_EQ(parse("a: \"x \\\" y\"\n").find("a")->text, "x \" y");
    EXPECT_EQ(parse("a: \"x\n  y\"\nb: 1\n").find("a")->text, "x y");
    EXPECT_EQ(parse("a: &x 'y'\nb: *x\n").find("b")->text, "y");
    EXPECT_EQ(parse("a: ! it's\nb: 1\n").find("a")->text, "it's");
    EXPECT_EQ(parse("{'a': \"\", \"b\": ''}").find("b")->text, "");
    EXPECT_EQ(parse("a: he said\n  'hello\nb: 1\n").find("a")->text, "he said 'hello");
}

TEST(YamlSource, NamesTheUsualCausesOfMalformedText) {
    for (const char* tab : {"a:\n\tb: 1\n", "\ta: 1\n", "a: 1\n\tb: 2\n"}) {
        EXPECT_TRUE(contains(refusal(tab), "the line begins with a tab; use spaces")) << tab;
    }
    for (const char* slip : {"a: b: c\n", "a: 1\n  b: 2\n", "a:\n  b: 1\n c: 2\n", "a 5\nb: 3\n"}) {
        EXPECT_TRUE(contains(refusal(slip), "a line that does not begin in the same column")) << slip;
        EXPECT_TRUE(contains(refusal(slip), "a tab at the start of a line")) << slip;
        EXPECT_TRUE(contains(refusal(slip), "a ': ' in a text without quotes")) << slip;
    }
    EXPECT_TRUE(contains(refusal("a: [1, 2\nb: 3\n"), "a closing ']' is missing"));
    EXPECT_TRUE(contains(refusal("a: {b: 1\nc: 2\n"), "a closing '}' is missing"));
    EXPECT_TRUE(contains(refusal("a: @b\n"), "a text that begins with this sign needs quotes"));
}

TEST(YamlSource, RefusesInvalidUtf8) {
    EXPECT_TRUE(
        contains(refusal(std::string("a: 1\nb: x\0y\n", 12)), "test.yaml:2:5: not a YAML text in UTF-8 (byte 0x00)"));
    EXPECT_TRUE(contains(refusal("a: \xff\xfe\n"), "test.yaml:1:4: not a YAML text in UTF-8 (byte 0xFF)"));
    EXPECT_TRUE(contains(refusal("a: \x1b[31m\n"), "byte 0x1B"));
    for (const char* broken : {"\xc3", "\xe2\x82", "\xf0\x9f\x9a", "\x80", "\xc0\xaf", "\xed\xa0\x80",
                               "\xf4\x90\x80\x80", "\xe0\x80\x80", "\xf0\x80\x80\x80", "\xf5\x80\x80\x80"}) {
        EXPECT_TRUE(contains(refusal(std::string("a: ") + broken), "not a YAML text in UTF-8")) << broken;
    }
    EXPECT_EQ(parse("a: Grün € 🚦\n").find("a")->text, "Grün € 🚦");
    EXPECT_EQ(parse("\xef\xbb\xbf"
                    "a: 1\n")
                  .find("a")
                  ->text,
              "1");  // after a byte order mark
    EXPECT_EQ(parse("a: 1\r\nb: 2\r\n").find("b")->text, "2");
}

// Each hostile text must be refused quickly, however large it is after its aliases (`*name`) are expanded.
class HostileYaml : public ::testing::Test {
protected:
    void expect_refused(const std::string& text, const std::string& reason) {
        const auto start = std::chrono::steady_clock::now();
        EXPECT_TRUE(contains(refusal(text), reason));
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        EXPECT_LT(taken.count(), 10.0);  // usually below 1 s; the limit allows for sanitizers and busy machines
    }
};

TEST_F(HostileYaml, RefusesBillionLaughs) {
    std::string text = "a0: &a0 [lol, lol, lol, lol, lol, lol, lol, lol, lol]\n";
    for (int i = 1; i < 10; ++i) {
        const std::string below = "*a" + std::to_string(i - 1);
        text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + below;
        for (int k = 0; k < 8; ++k) text += ", " + below;
        text += "]\n";
    }
    expect_refused(text, "more than 200000 values");
}

TEST_F(HostileYaml, RefusesAliasesThatGrowInDepth) {
    std::string text = "a0: &a0 [x]\n";
    for (int i = 1; i < 100; ++i) {
        text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [*a" + std::to_string(i - 1) + "]\n";
    }
    expect_refused(text, "levels deep");
}

TEST_F(HostileYaml, RefusesAnchorsThatContainThemselves) {
    expect_refused("a: &x [*x]\n", "inside its own anchor");
    expect_refused("a: &x {b: {c: *x}}\n", "inside its own anchor");
    expect_refused("&x a: *x\nb: &y\n  c: *y\n", "inside its own anchor");
}

TEST_F(HostileYaml, RefusesDeepNesting) {
    expect_refused(std::string(1'000'000, '['), "more than 1000 brackets are open here");
    expect_refused(std::string(1'000'000, '{'), "");
    std::string maps;
    for (int i = 0; i < 1000; ++i) maps += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
    expect_refused(maps, "levels deep");
    std::string lists;
    for (int i = 0; i < 100'000; ++i) lists += "- ";
    expect_refused(lists, "levels deep");
    std::string keys;
    for (int i = 0; i < 100'000; ++i) keys += "? ";
    expect_refused(keys, "");
    EXPECT_NE(refusal(keys), "");
}

TEST_F(HostileYaml, RefusesManyOpenBrackets) {
    expect_refused(std::string(1001, '['), "test.yaml:1:1001: more than 1000 brackets are open here");
    expect_refused("a: 1\n" + std::string(4'000'000, '{'), "test.yaml:2:1001: more than 1000 brackets are open here");
    EXPECT_EQ(parse("a: 'x " + std::string(900, '[') + "'\n").find("a")->text.size(), 902U);
}

TEST_F(HostileYaml, RefusesLongTextsThatAliasesRepeat) {
    std::string text = "a: &a " + std::string(1u << 20u, 'x') + "\nb: [*a";
    for (int i = 0; i < 1000; ++i) text += ", *a";
    expect_refused(text + "]\n", "the values are longer than 16 MB (aliases written out)");
}

TEST_F(HostileYaml, RefusesNestedAnchorsThatKeepManyCopies) {
    std::string text = "a: ";
    for (int i = 0; i < 20; ++i) text += "&a" + std::to_string(i) + " [";
    for (int i = 0; i < 50'000; ++i) text += "1,";
    expect_refused(text + std::string(20, ']') + "\n", "the anchors contain too many values");
}

TEST_F(HostileYaml, RefusesControlCharactersFromEscapeSequences) {
    EXPECT_TRUE(contains(refusal("a: 1\nb: \"x\\e[31m\"\n"), "test.yaml:2:4: the value has a control character"));
    EXPECT_TRUE(contains(refusal("\"\\x07\": 1\n"), "test.yaml:1:1: the value has a control character"));
    EXPECT_TRUE(contains(refusal("a: \"\\x9B\"\n"), "control character"));
    EXPECT_EQ(parse("a: \"one\\ntwo\"\n").find("a")->text, "one\ntwo");
}

TEST_F(HostileYaml, RefusesTooManyValues) {
    std::string text = "a: [";
    for (int i = 0; i < 300'000; ++i) text += "1,";
    expect_refused(text + "]\n", "more than 200000 values");
}

TEST_F(HostileYaml, LimitsTheSizeOfAText) {
    const SourceNode root = parse("a: " + std::string(2u << 20u, 'x') + "\n");
    EXPECT_EQ(root.find("a")->text.size(), 2u << 20u);
    expect_refused(std::string((4u << 20u) + 1, 'x'), "at most 4.0 MB");
}

TEST(YamlFile, RefusesUnreadableFiles) {
    const TemporaryFolder folder;
    const auto error_of_file = [](const std::filesystem::path& file) {
        return input_error_of([&] { read_yaml_file(file); });
    };
    EXPECT_TRUE(contains(error_of_file(folder.path() / "none.yaml"), "none.yaml: no such file"));
    EXPECT_TRUE(contains(error_of_file(folder.path()), "is a directory"));
    EXPECT_TRUE(contains(error_of_file(folder.path() / "none" / "none.yaml"), "no such file"));
    EXPECT_TRUE(contains(error_of_file(folder.write("f.yaml", "a: 1\n") / "below.yaml"), "no such file"));
    EXPECT_TRUE(contains(error_of_file("/dev/zero"), "is not a file that can be read"));
    const auto pipe = folder.path() / "pipe.yaml";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_TRUE(contains(error_of_file(pipe), "is not a file that can be read"));  // without waiting for a writer
    const auto loop = folder.path() / "loop.yaml";
    std::filesystem::create_symlink(loop, loop);
    EXPECT_NE(error_of_file(loop), "");
    if (::geteuid() != 0) {  // root may read everything
        const auto secret = folder.write("secret.yaml", "a: 1\n");
        std::filesystem::permissions(secret, std::filesystem::perms::none);
        EXPECT_TRUE(contains(error_of_file(secret), "cannot be opened"));
    }
}

TEST(YamlFile, RefusesAHugeFileWithoutReadingIt) {
    const TemporaryFolder folder;
    const auto file = folder.write("huge.yaml", "");
    std::filesystem::resize_file(file, std::uintmax_t{5} << 40u);  // an empty file of 5 TB
    EXPECT_TRUE(contains(input_error_of([&] { read_yaml_file(file); }), "at most 4.0 MB"));
}

}  // namespace
}  // namespace stopline

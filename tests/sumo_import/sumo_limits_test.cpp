// Tests of the limits of SUMO's files: small files that would need much memory or time are refused at once.
#include <gtest/gtest.h>
#include <zlib.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "sumo_import/sumo_graph.h"
#include "sumo_import/sumo_net.h"
#include "sumo_import/xml/xml_text.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

using testing::crossing_net;
using testing::refusal;
using testing::replaced;
using testing::SumoFiles;

constexpr double kClearance_m = 2.0;

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Fails if an action takes longer than input of this size may take. Usually it takes a tenth of a second; the limit
// allows for sanitizers and busy machines.
template <class Act>
void expect_quick(const Act& action) {
    const auto start = std::chrono::steady_clock::now();
    action();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    EXPECT_LT(taken.count(), 15.0);
}

class XmlFiles : public ::testing::Test {
protected:
    std::filesystem::path gzipped(const std::string& text) const {
        const std::filesystem::path file = files_.folder() / "my.net.xml.gz";
        const gzFile out = gzopen(file.c_str(), "wb9");
        gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
        gzclose(out);
        return file;
    }
    static std::string content(const std::filesystem::path& file) {
        std::ifstream stream(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    std::string refusal_of(const std::string& text) const {
        return refusal([&] { read_sumo_net(files_.write("my.net.xml", text)); });
    }
    SumoNetwork network_of(const std::string& text) const {
        return make_sumo_network(read_sumo_net(files_.write("my.net.xml", text)), kClearance_m);
    }

    SumoFiles files_;
};

TEST_F(XmlFiles, SmallFilesThatNeedMuchMemoryAreRefused) {
    std::string elements = "<net>";
    for (int k = 0; k < 5'000'000; ++k) elements += "<a/>";
    const std::string lines = "<net>" + std::string(100'000'000, '\n') + "</net>";
    const std::string attributes = "<net>" + std::string(100'000'000, '=') + "</net>";
    for (const std::string& text : {elements + "</net>", lines, attributes}) {
        const std::filesystem::path file = gzipped(text);
        ASSERT_LT(std::filesystem::file_size(file), 200'000U);
        expect_quick([&] {
            const std::string message = refusal([&] { read_sumo_net(file); });
            EXPECT_TRUE(contains(message, "my.net.xml.gz: the file has 0 MB and would need more than")) << message;
        });
    }
}

TEST(XmlMemory, GrowsWithElementsAttributesAndLines) {
    EXPECT_EQ(xml_memory("abc"), 3U);
    EXPECT_GT(xml_memory("<a b='1'/>\n"), 128U);
    EXPECT_LT(xml_memory(crossing_net()), 6 * crossing_net().size());
}

TEST_F(XmlFiles, BytesAfterTheGzipDataAreRefused) {
    const std::string packed = content(gzipped(crossing_net()));
    const auto read = [&](const std::string& bytes) { return read_sumo_net(files_.write("my.net.xml.gz", bytes)); };
    const std::string message = refusal([&] { read(packed + "<edge/>"); });
    EXPECT_EQ(message, "my.net.xml.gz: 7 bytes follow the end of the gzip data, from byte " +
                           std::to_string(packed.size()) + " on; remove them");
    EXPECT_EQ(read(packed + std::string(512, '\0')).edges.size(), 8U);
    // gzip data may consist of several members, one after the other.
    const std::string text = crossing_net();
    const std::string first = content(gzipped(text.substr(0, 1000)));
    EXPECT_EQ(read(first + content(gzipped(text.substr(1000)))).edges.size(), 8U);
}

TEST_F(XmlFiles, NestingAndAttributesAreLimited) {
    std::string deep = "<net>";
    for (int k = 0; k < 200; ++k) deep += "<a>";
    for (int k = 0; k < 200; ++k) deep += "</a>";
    EXPECT_TRUE(contains(refusal_of(deep + "</net>"), "my.net.xml:1: the elements are nested more than 100 levels"));
    std::string wide = "<net>\n<edge";
    for (int k = 0; k < 1001; ++k) wide += " a" + std::to_string(k) + "=''";
    EXPECT_TRUE(contains(refusal_of(wide + "/></net>"), "my.net.xml:2: element 'edge' has 1001 attributes"));
}

TEST_F(XmlFiles, ControlCharactersAreRefused) {
    const std::string net = crossing_net();
    EXPECT_TRUE(contains(refusal_of(replaced(net, "id=\"w_in\"", "id=\"w\x1b[31m\"")), "control character 0x1B"));
    for (const char* const code : {"&#27;", "&#x1b;", "&#0;", "&#xD800;", "&#x110000;"}) {
        const std::string message = refusal_of(replaced(net, "id=\"w_in\"", "id=\"w" + std::string(code) + "\""));
        EXPECT_TRUE(contains(message, "is not an XML entity")) << message;
    }
    EXPECT_TRUE(
        contains(refusal_of(replaced(net, "id=\"w_in\"", "id=\"w&#10;x\"")), ":17: element 'edge': the id has"));
}

TEST_F(XmlFiles, NamesInMessagesAndWarningsArePrintable) {
    const std::string strange =
        "\xC2\x9B"
        "31m\xE2\x80\xAE";  // control sequence introducer, right-to-left override
    const std::string message = refusal_of(replaced(crossing_net(), "from=\"W\"", "from=\"" + strange + "\""));
    EXPECT_TRUE(contains(message, R"(from="\xC2\x9B31m\xE2\x80\xAE")")) << message;
    SumoWarnings warnings;
    warnings.note("my.net.xml:1", "'\x1b[2J' is ignored");
    EXPECT_EQ(warnings.lines(), std::vector<std::string>{R"(my.net.xml:1: '\x1B[2J' is ignored)"});
}

TEST_F(XmlFiles, LanesOfAnEdgeAreLimited) {
    std::string lanes;
    for (int k = 0; k < 10'000; ++k) {
        const std::string number = std::to_string(k);
        lanes +=
            "<lane id=\"many_" + number + "\" index=\"" + number + "\" speed=\"9\" length=\"9\" shape=\"0,0 9,0\"/>\n";
    }
    const std::string text =
        replaced(crossing_net(), "<edge id=\"w_in\"",
                 "<edge id=\"many\" from=\"W\" to=\"J\">\n" + lanes + "</edge>\n<edge id=\"w_in\"");
    expect_quick(
        [&] { EXPECT_TRUE(contains(refusal_of(text), "my.net.xml:118: edge 'many' has more than 100 lanes")); });
}

TEST_F(XmlFiles, TinyLanesAndSpeedsAreRefused) {
    const std::string net = crossing_net();
    EXPECT_TRUE(contains(refusal_of(replaced(net, "length=\"190.00\"", "length=\"1e-9\"")),
                         ":18: length=\"1e-9\" must be from 0.01 to 1000000 m"));
    EXPECT_TRUE(
        contains(refusal_of(replaced(net, "speed=\"13.89\" length=\"190.00\"", "speed=\"1e-300\" length=\"190\"")),
                 ":18: speed=\"1e-300\" must be from 0.01 to 200 m/s"));
}

TEST_F(XmlFiles, ConnectionsAreLimited) {
    const std::string connection = "<connection from=\"w_in\" to=\"e_out\" fromLane=\"0\" toLane=\"0\" via=\":J_1_0\"";
    const std::string twice = replaced(crossing_net(), connection, connection + "/>\n" + connection);
    EXPECT_TRUE(contains(refusal_of(twice), "there are two connections from lane 0 of edge 'w_in' to lane 0 of edge"));
    const std::string far = replaced(crossing_net(), "-10.00,-4.80 10.00,-4.80", "-10.00,-4.80 1e7,5 10.00,-4.80");
    EXPECT_TRUE(contains(refusal([&] { network_of(far); }), "is 20000000 m long; at most 2000 m are allowed"));
}

// Each junction has a warning of its own here. Listing them took quadratic time.
TEST_F(XmlFiles, ManyDifferentWarningsTakeLinearTime) {
    SumoWarnings warnings;
    expect_quick([&] {
        for (int k = 0; k < 200'000; ++k) warnings.note("my.net.xml:1", "junction 'j" + std::to_string(k) + "'");
    });
    EXPECT_EQ(warnings.lines().size(), 200'000U);
}

// Returns a road of many edges that are too short to keep. All are merged into the first one.
std::string short_edges(int count) {
    std::string edges;
    std::string junctions = "<junction id=\"j0\" type=\"dead_end\"/>";
    std::string connections;
    const auto place = [](double x) { return std::to_string(x) + ",0"; };
    for (int k = 0; k < count; ++k) {
        const std::string number = std::to_string(k);
        const double begin = k == 0 ? -100.0 : k;
        edges += "<edge id=\"e" + number + "\" from=\"j0\" to=\"j0\"><lane id=\"e" + number +
                 "_0\" index=\"0\" speed=\"9\" length=\"" + (k == 0 ? "101" : "1") + "\" shape=\"" + place(begin) +
                 " " + place(k + 1.0) + "\"/></edge>\n<edge id=\":v" + number +
                 "\" function=\"internal\"><lane id=\":v" + number +
                 "_0\" index=\"0\" speed=\"9\" length=\"0.1\" shape=\"" + place(k + 1.0) + " " + place(k + 1.05) +
                 "\"/></edge>\n";
        if (k + 1 == count) break;
        const std::string to = " to=\"e" + std::to_string(k + 1) + "\" fromLane=\"0\" toLane=\"0\"";
        connections += "<connection from=\"e" + number + "\"" + to + " via=\":v" + number + "_0\" dir=\"s\"/>\n";
        connections += "<connection from=\":v" + number + "\"" + to + " dir=\"s\"/>\n";
    }
    return "<net>" + edges + junctions + connections + "</net>";
}

TEST_F(XmlFiles, LongChainsOfShortEdgesTakeLinearTime) {
    expect_quick([&] {
        const SumoNetwork network = network_of(short_edges(20'000));
        EXPECT_LT(network.graph.lanes.size(), 20'000U);
    });
}

TEST_F(XmlFiles, SignalsWithManyPhasesAreRefused) {
    std::string phases;
    for (int k = 0; k < 1001; ++k) phases += "<phase duration=\"3\" state=\"GGGG\"/>\n";
    const std::string text = replaced(testing::signal_net(testing::two_phases()), "<phase ", phases + "<phase ");
    EXPECT_TRUE(contains(refusal_of(text), ":1033: tlLogic 'J' has more than 1000 phases"));
}

// Rings of many phases took quadratic memory, because each phase of one ring forms a pair with each of the other ring.
TEST_F(XmlFiles, RingsOfManyPhasesRunAsFixedTimeSignals) {
    const std::string ring(3000, '1');
    const std::string parameters = "<param key=\"ring1\" value=\"" + ring + "\"/><param key=\"ring2\" value=\"2\"/>";
    std::string text = testing::signal_net(testing::two_phases());
    text = replaced(replaced(text, "type=\"static\"", "type=\"NEMA\""), "<phase ", parameters + "<phase ");
    expect_quick([&] {
        const SumoNetwork network = network_of(text);
        const std::vector<std::string> lines = network.net.warnings.lines();
        ASSERT_FALSE(lines.empty());
        EXPECT_TRUE(contains(lines[0], "the rings of the signal 'J' are not supported: a ring has more than 9 phases"));
        EXPECT_EQ(network.net.signals[0].controller, nullptr);
    });
}

// The lights of two rings are computed for each tick of their cycle.
TEST_F(XmlFiles, LongClearanceTimesOfSignalsAreRefused) {
    const std::string text = testing::signal_net(testing::two_phases());
    for (const char* const name : {"yellow", "red", "vehext"}) {
        const std::string attribute = std::string(name) + "=\"1e9\"";
        const std::string message = refusal_of(replaced(text, "<phase ", "<phase " + attribute + " "));
        EXPECT_TRUE(contains(message, attribute + " must be from 0 to 300 s")) << message;
    }
}

}  // namespace
}  // namespace stopline

// Tests of hostile input. Any file is loaded or refused with an InputError, without a crash or an endless loop.
#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "scenario/scenario_text.h"

namespace stopline {
namespace {

TEST(HostileFile, RefusesHundredMegabytesOfGarbage) {
    const TemporaryFolder folder;
    std::mt19937_64 random(1);
    std::string block(1u << 20u, '\0');
    const auto file = folder.path() / "garbage.yaml";
    std::ofstream stream(file, std::ios::binary);
    for (int megabyte = 0; megabyte < 100; ++megabyte) {
        for (std::size_t i = 0; i < block.size(); i += 8) {
            const std::uint64_t bits = random();
            for (std::size_t k = 0; k < 8; ++k) block[i + k] = static_cast<char>(bits >> (8 * k));
        }
        stream << block;
    }
    stream.close();
    ASSERT_EQ(std::filesystem::file_size(file), 100u << 20u);
    EXPECT_TRUE(
        contains(input_error_of([&] { load_scenario(file); }), "garbage.yaml: has 100.0 MB; at most 4.0 MB are read"));
    folder.write("run.yaml", "vehicle: ./garbage.yaml\n");
    EXPECT_TRUE(contains(input_error_of([&] { load_scenario(folder.path() / "run.yaml"); }), "at most 4.0 MB"));
    std::filesystem::resize_file(file, 1u << 20u);
    EXPECT_TRUE(contains(input_error_of([&] { load_scenario(file); }), "not a YAML text in UTF-8"));
}

// Returns the text with random changes: flipped, deleted or copied bytes, or inserted parts of YAML syntax.
std::string mutated(std::string text, std::mt19937_64& random) {
    static const std::vector<std::string> kPieces{"&a ",
                                                  "*a",
                                                  "<<: ",
                                                  "- ",
                                                  "? ",
                                                  ": ",
                                                  "[",
                                                  "]",
                                                  "{",
                                                  "}",
                                                  "|\n",
                                                  ">\n",
                                                  "!x ",
                                                  "!!map ",
                                                  "\"",
                                                  "'",
                                                  "\\",
                                                  "#",
                                                  "\n",
                                                  "\n\n",
                                                  "  ",
                                                  "\t",
                                                  "---\n",
                                                  "...\n",
                                                  "%YAML 1.1\n",
                                                  "~",
                                                  "nan",
                                                  ".inf",
                                                  "-1",
                                                  "1e999",
                                                  "0",
                                                  "99999999999999999999",
                                                  " km/h",
                                                  " s",
                                                  " %",
                                                  "\xff",
                                                  "\xc3",
                                                  std::string(1, '\0'),
                                                  "\xef\xbb\xbf",
                                                  "base: ",
                                                  "name: ",
                                                  ","};
    const auto random_below = [&](std::size_t n) { return static_cast<std::size_t>(random() % (n == 0 ? 1 : n)); };
    const std::size_t changes = 1 + random_below(4);
    for (std::size_t i = 0; i < changes; ++i) {
        const std::size_t at = random_below(text.size());
        const std::size_t length = std::min(text.size() - at, 1 + random_below(30));
        switch (random_below(6)) {
            case 0:
                text[at] = static_cast<char>(random() & 0xFFu);
                break;
            case 1:
                text.erase(at, length);
                break;
            case 2:
                text.insert(at, text.substr(random_below(text.size()), length));
                break;
            case 3:
                text.resize(at);
                break;
            default:
                text.insert(at, kPieces[random_below(kPieces.size())]);
                break;
        }
        if (text.empty()) break;
    }
    return text;
}

struct Outcome {
    int loaded = 0;
    int refused = 0;
};

// Loads `cases` mutations. A mutation that loads must have a canonical text that loads again.
Outcome load_mutations(const std::string& text, int cases, std::uint64_t seed) {
    Outcome outcome;
    std::mt19937_64 random(seed);
    for (int i = 0; i < cases; ++i) {
        const std::string bad = mutated(text, random);
        SCOPED_TRACE(bad);
        Scenario scenario;
        const std::string message = input_error_of([&] { scenario = parse_scenario(bad, "test.yaml"); });
        if (!message.empty()) {
            EXPECT_TRUE(message.starts_with("test.yaml:") || message.find(".yaml:") != std::string::npos) << message;
            ++outcome.refused;
            continue;
        }
        ++outcome.loaded;
        const std::string canonical = canonical_text(scenario);
        EXPECT_EQ(canonical_text(parse_scenario(canonical, "test.yaml")), canonical);
    }
    return outcome;
}

TEST(HostileFile, MutatedScenariosLoadOrAreRefused) {
    const std::string file = read_text(shipped("scenarios/single_light.yaml"));
    const Outcome of_file = load_mutations(file, 1000, 2);
    EXPECT_GT(of_file.refused, 300);  // many mutations are errors
    EXPECT_GT(of_file.loaded, 50);    // some mutations still load
    const std::string canonical = canonical_text(load_scenario(shipped("scenarios/single_light.yaml")));
    const Outcome of_canonical = load_mutations(canonical, 1000, 3);
    EXPECT_GT(of_canonical.refused, 300);
    EXPECT_GT(of_canonical.loaded, 5);
}

TEST(HostileFile, MutatedOverridesAreAppliedOrRefused) {
    const std::vector<std::string> good{"signal.green=20 s",
                                        "vehicle=diesel_eu4_103kw",
                                        "vehicle.mass=1.4 t",
                                        "measure.green=[5 s, 10 s]",
                                        "populations[MIX].components[1].share=50 %",
                                        "policies[CTG-Ref].time_gap=0.6 s",
                                        "driver.free_drive.acceleration={0 km/h: 2 m/s2}"};
    std::mt19937_64 random(4);
    int refused = 0;
    for (int i = 0; i < 1000; ++i) {
        const std::string bad = mutated(good[static_cast<std::size_t>(random() % good.size())], random);
        SCOPED_TRACE(bad);
        if (!error_of("title: x\n", {bad}).empty()) ++refused;
    }
    EXPECT_GT(refused, 500);
    EXPECT_LT(refused, 1000);
}

TEST(HostileFile, LongWordsAreCutInMessages) {
    const std::string word(1'000'000, 'x');
    for (const std::string& text :
         {word + ": 1\n", "step: " + word + "\n", "vehicle: " + word + "\n", "vehicle: " + word + ".yaml\n",
          "fidelity: " + word + "\n", "name: " + word + "\n", "populations: [" + word + "]\n",
          "vehicle: {base: petrol_eu4_72kw, full_load: {" + word.substr(0, 900) + ": 1}}\n"}) {
        const std::string message = error_of(text);
        EXPECT_NE(message, "");
        EXPECT_LT(message.size(), 3000u) << message.substr(0, 3000);
    }
    EXPECT_LT(error_of("title: x\n", {word}).size(), 1000u);
    EXPECT_LT(error_of("title: x\n", {word + "=1"}).size(), 1000u);
    EXPECT_LT(error_of("title: x\n", {"populations[" + word + "].name=1"}).size(), 1000u);
}

// Each entry of the list was compared with all others.
TEST(HostileFile, LongListsOfPoliciesTakeLinearTime) {
    std::string text = "policies:\n";
    for (int k = 0; k < 190'000; ++k) text += "- P\n";
    const auto start = std::chrono::steady_clock::now();
    EXPECT_NE(input_error_of([&] { parse_scenario(text, "test.yaml"); }), "");
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    EXPECT_LT(taken.count(), 15.0);
}

}  // namespace
}  // namespace stopline

// Reads all seeds of the fuzz targets, and thus all inputs that a campaign has found, in the build of the programs. A
// target ends the process if its input has another outcome than success or an InputError.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "fuzz/targets.h"

namespace stopline::fuzz {
namespace {

std::string content_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

class FuzzSeeds : public ::testing::TestWithParam<std::string> {};

TEST_P(FuzzSeeds, EndWithSuccessOrInputError) {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(seeds_folder() / GetParam())) {
        SCOPED_TRACE(entry.path().string());
        const std::string input = content_of(entry.path());
        target(GetParam()).run(input);
        ++count;
    }
    EXPECT_GT(count, 0);
}

INSTANTIATE_TEST_SUITE_P(AllTargets, FuzzSeeds, ::testing::ValuesIn([] {
                             std::vector<std::string> names;
                             for (const Target& one : targets()) names.emplace_back(one.name);
                             return names;
                         }()),
                         [](const auto& seed_folder) { return seed_folder.param; });

}  // namespace
}  // namespace stopline::fuzz

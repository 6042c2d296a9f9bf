#include "base/version.h"

#include <gtest/gtest.h>

#include <regex>

namespace stopline {
namespace {

TEST(Version, NamesTheReleaseAndTheRevision) {
    EXPECT_TRUE(std::regex_match(version(), std::regex(R"(\d+\.\d+\.\d+ \([0-9A-Za-z.-]+\))"))) << version();
}

}  // namespace
}  // namespace stopline

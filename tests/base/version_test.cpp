#include "base/version.h"

#include <gtest/gtest.h>

#include <string>

namespace stopline {
namespace {

TEST(Version, NamesTheReleaseAndTheRevision) {
    const std::string text = version();
    const std::size_t open = text.find(" (");
    ASSERT_NE(open, std::string::npos) << text;
    EXPECT_EQ(text.substr(0, open).find_first_not_of("0123456789."), std::string::npos) << text;
    EXPECT_GT(text.size(), open + 3) << text;
    EXPECT_EQ(text.back(), ')');
}

}  // namespace
}  // namespace stopline

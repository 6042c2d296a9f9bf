// Tests of CommandFiles: an output never has the path of an input or of another output, also through links.
#include "base/io/command_files.h"

#include <gtest/gtest.h>

#include "scenario/scenario_text.h"

namespace stopline {
namespace {

namespace fs = std::filesystem;

class CommandFilesTest : public ::testing::Test {
protected:
    std::string output_error(const fs::path& file) {
        return input_error_of([&] { files_.add_output(file, "--record"); });
    }

    TemporaryFolder folder_;
    fs::path input_ = folder_.write("in.yaml", "text");
    CommandFiles files_;
};

TEST_F(CommandFilesTest, RefusesAnOutputThatIsAnInput) {
    files_.add_input(input_, "the scenario");
    files_.add_input(input_, "another role");
    EXPECT_EQ(output_error(input_), "'" + input_.string() + "' (--record) would overwrite '" + input_.string() +
                                        "' (the scenario); give another file");
    EXPECT_TRUE(contains(output_error(folder_.path() / "." / "in.yaml"), "would overwrite"));
    EXPECT_TRUE(contains(output_error(folder_.path() / "none" / ".." / "in.yaml"), "would overwrite"));
    fs::create_symlink(input_, folder_.path() / "link.rec");
    EXPECT_TRUE(contains(output_error(folder_.path() / "link.rec"), "would overwrite"));
    fs::create_hard_link(input_, folder_.path() / "hard.rec");
    EXPECT_TRUE(contains(output_error(folder_.path() / "hard.rec"), "would overwrite"));
    EXPECT_EQ(output_error(folder_.path() / "other.rec"), "");
}

TEST_F(CommandFilesTest, RefusesAFolderLinkToTheSameFile) {
    fs::create_directory(folder_.path() / "real");
    fs::create_directory_symlink(folder_.path() / "real", folder_.path() / "alias");
    files_.add_output(folder_.path() / "real" / "new.xml", "--fcd");
    EXPECT_TRUE(contains(output_error(folder_.path() / "alias" / "new.xml"), "(--fcd)"));
}

TEST_F(CommandFilesTest, RefusesTwoOutputsOfOneName) {
    files_.add_outputs(folder_.path() / "out", {"summary.csv", "series.csv"}, "a table in the folder of --output");
    EXPECT_TRUE(contains(output_error(folder_.path() / "out" / "series.csv"), "(a table in the folder of --output)"));
    EXPECT_EQ(output_error(folder_.path() / "out" / "other.csv"), "");
}

TEST_F(CommandFilesTest, RefusesAnInputThatIsAnOutput) {
    files_.add_output(input_, "--write");
    EXPECT_TRUE(contains(input_error_of([&] { files_.add_input(input_, "--measured"); }),
                         "(--write) would overwrite '" + input_.string() + "' (--measured)"));
}

TEST_F(CommandFilesTest, LeavesDevicesAndMissingOptionsOut) {
    for (const char* const file : {"/dev/null", ""}) {
        files_.add_input(file, "the scenario");
        EXPECT_EQ(output_error(file), "");
        EXPECT_EQ(output_error(file), "");
    }
}

}  // namespace
}  // namespace stopline

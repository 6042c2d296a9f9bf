// Tests of file output: a file appears complete or not at all, and an error names the path and the reason.
#include "base/io/output.h"

#include <gtest/gtest.h>
#include <signal.h>  // SIGXFSZ is POSIX
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <iterator>
#include <string>

#include "base/io/replaced_file.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

namespace fs = std::filesystem;

std::size_t count_files(const fs::path& folder) {
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder)) ++files;
    return files;
}

TEST(WriteFile, CreatesAndReplacesAFileWithoutLeftovers) {
    const TemporaryFolder folder;
    write_file(folder.path() / "a.csv", "first");
    write_file(folder.path() / "a.csv", "second, longer");
    EXPECT_EQ(read_text(folder.path() / "a.csv"), "second, longer");
    EXPECT_EQ(count_files(folder.path()), 1U);
}

TEST(WriteFile, KeepsTheOldFileIfWritingFails) {
    const TemporaryFolder folder;
    const fs::path file = folder.write("a.csv", "old");
    // A file size limit stands in for a full disk: write() fails halfway.
    rlimit old_limit{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old_limit), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small_limit{1000, old_limit.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small_limit), 0);
    const std::string error = input_error_of([&] { write_file(file, std::string(5000, 'x')); });
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &old_limit), 0);
    std::signal(SIGXFSZ, handler);
    EXPECT_TRUE(contains(error, file.string()));
    EXPECT_TRUE(contains(error, "File too large"));
    EXPECT_EQ(read_text(file), "old");
    EXPECT_EQ(count_files(folder.path()), 1U) << "a partial file is left";
}

TEST(RemoveStaleParts, RemovesPartsOfEndedProcesses) {
    const TemporaryFolder folder;
    const pid_t ended_process = ::fork();
    if (ended_process == 0) ::_exit(0);
    ASSERT_EQ(::waitpid(ended_process, nullptr, 0), ended_process);
    const std::string own = temporary_path("a.csv").string();  // .a.csv.MACHINE.PROCESS.part
    const std::string machine = own.substr(6, own.find('.', 7) - 6);
    const std::string ended = std::to_string(ended_process);
    folder.write(".a.csv" + machine + "." + ended + ".part", "half");
    folder.write(".a.sqlite" + machine + "." + ended + ".part-wal", "half");
    fs::create_directory(folder.path() / (".files" + machine + "." + ended + ".part"));
    folder.write(".files" + machine + "." + ended + ".part/net.xml", "half");
    const std::string kept[] = {own,
                                ".a.csv.otherhost." + ended + ".part",
                                "a.csv" + machine + "." + ended + ".part",
                                ".a.csv.part",
                                ".a.csv" + machine + ".-1.part",
                                ".a.csv" + machine + ".12x.part",
                                "." + ended + ".part",
                                ".a.csv" + machine + "." + ended};
    for (const std::string& name : kept) folder.write(name, "other");
    prepare_folder(folder.path());  // calls remove_stale_parts()
    for (const std::string& name : kept) EXPECT_TRUE(fs::exists(folder.path() / name)) << name;
    EXPECT_EQ(count_files(folder.path()), std::size(kept));
    remove_stale_parts(folder.path() / "none");
}

TEST(PrepareOutputFile, ReportsAFileThatCannotBeWritten) {
    const TemporaryFolder folder;
    const fs::path file = folder.write("a.yaml", "old");
    const auto error_of = [](const fs::path& wanted) { return input_error_of([&] { prepare_output_file(wanted); }); };
    EXPECT_EQ(error_of(file), "");
    EXPECT_EQ(read_text(file), "old");
    EXPECT_EQ(error_of(folder.path() / "new" / "b.yaml"), "");
    EXPECT_FALSE(fs::exists(folder.path() / "new" / "b.yaml"));
    EXPECT_TRUE(contains(error_of(folder.path()), "Is a directory"));
    EXPECT_TRUE(contains(error_of(folder.path() / ""), "add the name of a file"));
    EXPECT_TRUE(contains(error_of(file / "below"), "Not a directory"));
    EXPECT_EQ(error_of("/dev/null"), "");
    EXPECT_TRUE(contains(error_of(folder.path() / std::string(250, 'x')), "File name too long"))
        << "the temporary file needs a longer name";
    EXPECT_EQ(count_files(folder.path()), 2U) << "a temporary file is left";
}

TEST(WriteFile, ReportsAFullDevice) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
    const std::string error = input_error_of([] { write_file("/dev/full", "text"); });
    EXPECT_TRUE(contains(error, "/dev/full"));
    EXPECT_TRUE(contains(error, "No space left on device"));
    EXPECT_TRUE(fs::is_character_file("/dev/full")) << "the device was replaced by a file";
}

TEST(WriteFile, WritesThroughASymbolicLink) {
    const TemporaryFolder folder;
    const fs::path real = folder.write("real.csv", "old");
    fs::create_symlink(real, folder.path() / "link.csv");
    write_file(folder.path() / "link.csv", "new");
    EXPECT_TRUE(fs::is_symlink(folder.path() / "link.csv"));
    EXPECT_EQ(read_text(real), "new");
}

TEST(WriteFile, RefusesAFolderAndAMissingFolder) {
    const TemporaryFolder folder;
    EXPECT_TRUE(contains(input_error_of([&] { write_file(folder.path(), "x"); }), "Is a directory"));
    const fs::path missing = folder.path() / "none" / "a.csv";
    EXPECT_TRUE(contains(input_error_of([&] { write_file(missing, "x"); }), "No such file or directory"));
}

TEST(PrepareFolder, CreatesParentsAndAcceptsAnExistingFolder) {
    const TemporaryFolder folder;
    prepare_folder(folder.path() / "a" / "b");
    prepare_folder(folder.path() / "a" / "b");
    EXPECT_TRUE(fs::is_directory(folder.path() / "a" / "b"));
}

TEST(PrepareFolder, ReportsWhyItFails) {
    const TemporaryFolder folder;
    const fs::path file = folder.write("file", "x");
    EXPECT_TRUE(contains(input_error_of([&] { prepare_folder(file); }), file.string()));
    EXPECT_TRUE(contains(input_error_of([&] { prepare_folder(file / "below"); }), "Not a directory"));
    if (::geteuid() == 0) return;  // root may write everywhere
    fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_TRUE(contains(input_error_of([&] { prepare_folder(folder.path()); }), "Permission denied"));
    fs::permissions(folder.path(), fs::perms::owner_all);
}

TEST(ReadFile, ReturnsTheBytesOrReportsPathAndReason) {
    const TemporaryFolder folder;
    const fs::path file = folder.write("a", std::string("a\0b\r\n", 5));
    EXPECT_EQ(read_file(file), std::string("a\0b\r\n", 5));
    const std::string error = input_error_of([&] { read_file(folder.path() / "none"); });
    EXPECT_TRUE(contains(error, "none: cannot read: No such file or directory"));
    EXPECT_TRUE(contains(input_error_of([&] { read_file(folder.path()); }), "Is a directory"));
}

}  // namespace
}  // namespace stopline

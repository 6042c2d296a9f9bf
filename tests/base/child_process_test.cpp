// Tests of run_process(): output, failures, and stopping a program.
#include "base/io/child_process.h"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>

namespace stopline {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

TEST(ChildProcess, ReturnsOutputAndStatus) {
    const ProcessResult result = run_process({"sh", "-c", "echo out; echo err >&2; exit 3"}, ".");
    EXPECT_TRUE(result.failed());
    EXPECT_FALSE(result.stopped);
    EXPECT_EQ(result.output, "out\nerr\n");
    EXPECT_TRUE(run_process({"no-such-program"}, ".").failed());
}

TEST(ChildProcess, ShowsTheOutputSoFar) {
    std::string first;
    const ProcessResult result = run_process({"sh", "-c", "echo one; sleep 0.6; echo two"}, ".", [&](const auto& text) {
        if (first.empty()) first = text;
        return true;
    });
    EXPECT_EQ(first, "one\n");
    EXPECT_EQ(result.output, "one\ntwo\n");
    EXPECT_FALSE(result.failed());
}

TEST(ChildProcess, KillsTheProgramOnRequest) {
    const Clock::time_point start = Clock::now();
    const ProcessResult result =
        run_process({"sleep", "60"}, ".", [&](const auto&) { return seconds_since(start) < 0.3; });
    EXPECT_TRUE(result.stopped);
    EXPECT_TRUE(result.failed());
    const auto fail = [](const std::string&) -> bool { throw std::runtime_error("stop"); };
    EXPECT_THROW(run_process({"sleep", "60"}, ".", fail), std::runtime_error);
    EXPECT_LT(seconds_since(start), 30.0);
}

}  // namespace
}  // namespace stopline

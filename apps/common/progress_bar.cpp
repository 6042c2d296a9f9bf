#include "common/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <fmt/core.h>

#include "base/io/console.h"
#include "common/program.h"

namespace stopline {

namespace {

constexpr double kQuietTime_s = 2.0;
constexpr double kRedrawInterval_s = 0.1;
constexpr double kPlainLineInterval_s = 10.0;

}  // namespace

ProgressBar::ProgressBar(std::string label)
    : label_(std::move(label)), is_terminal_(::isatty(STDERR_FILENO) == 1), begin_(Clock::now()), last_shown_(begin_) {}

ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::clear() {
    if (on_screen_) std::fputs("\r\033[K", stderr);
    on_screen_ = false;
}

bool ProgressBar::update(double share) { return update(share, label_, std::nullopt); }

bool ProgressBar::update(double share, const std::string& label, std::optional<double> remaining_s) {
    const Clock::time_point now = Clock::now();
    // A large drop of the share means that a new task has begun, so the estimate of the remaining time starts anew.
    constexpr double kNewTaskDrop = 0.5;
    if (share < last_share_ - kNewTaskDrop) begin_ = now;
    last_share_ = share;
    const double elapsed_s = std::chrono::duration<double>(now - begin_).count();
    const double since_shown_s = std::chrono::duration<double>(now - last_shown_).count();
    if (elapsed_s >= kQuietTime_s && since_shown_s >= (is_terminal_ ? kRedrawInterval_s : kPlainLineInterval_s)) {
        const std::string text = remaining_s ? progress_text_with_remaining(label, share, *remaining_s)
                                             : progress_text(label, share, elapsed_s);
        if (is_terminal_) {
            print_message("\r{}\033[K", text);
            std::fflush(stderr);
        } else {
            print_message("{}\n", text);
        }
        on_screen_ = is_terminal_;
        last_shown_ = now;
    }
    return !interrupted();
}

namespace {

std::string bar_text(const std::string& label, double share, const std::string& remaining) {
    constexpr int kBarCells = 30;
    const double done = std::clamp(share, 0.0, 1.0);
    const int filled = static_cast<int>(std::floor(done * kBarCells));
    std::string bar(static_cast<std::size_t>(filled), '#');
    bar.resize(kBarCells, '.');
    return fmt::format("{} [{}] {:3.0f} %{}{}", label, bar, std::floor(100.0 * done), remaining.empty() ? "" : ", ",
                       remaining);
}

}  // namespace

std::string progress_text(const std::string& label, double share, double elapsed_s) {
    const double done = std::clamp(share, 0.0, 1.0);
    return bar_text(label, share, done > 0.0 ? duration_text(elapsed_s * (1.0 - done) / done) + " left" : "");
}

std::string progress_text_with_remaining(const std::string& label, double share, double remaining_s) {
    return bar_text(label, share, duration_text(remaining_s) + " left");
}

std::string duration_text(double seconds) {
    const auto whole = static_cast<long>(std::ceil(seconds));
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace stopline

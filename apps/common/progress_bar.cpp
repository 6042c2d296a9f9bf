#include "common/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <fmt/core.h>

#include "common/program.h"

namespace stopline {

namespace {

constexpr double kSilent_s = 2.0;
constexpr double kRedraw_s = 0.1;
constexpr double kPlainLine_s = 10.0;

}  // namespace

ProgressBar::ProgressBar(std::string label)
    : label_(std::move(label)), terminal_(::isatty(STDERR_FILENO) == 1), begin_(Clock::now()), last_shown_(begin_) {}

ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::clear() {
    if (on_screen_) std::fputs("\r\033[K", stderr);
    on_screen_ = false;
}

bool ProgressBar::update(double share) { return update(share, label_, std::nullopt); }

bool ProgressBar::update(double share, const std::string& label, std::optional<double> left_s) {
    constexpr double kMuchLess = 0.5;
    const Clock::time_point now = Clock::now();
    if (share < last_share_ - kMuchLess) begin_ = now;  // the next work: what came before says nothing of it
    last_share_ = share;
    const double elapsed_s = std::chrono::duration<double>(now - begin_).count();
    const double since_s = std::chrono::duration<double>(now - last_shown_).count();
    if (elapsed_s >= kSilent_s && since_s >= (terminal_ ? kRedraw_s : kPlainLine_s)) {
        const std::string text =
            left_s ? progress_text_with(label, share, *left_s) : progress_text(label, share, elapsed_s);
        if (terminal_) {
            fmt::print(stderr, "\r{}\033[K", text);
            std::fflush(stderr);
        } else {
            fmt::print(stderr, "{}\n", text);
        }
        on_screen_ = terminal_;
        last_shown_ = now;
    }
    return !interrupted();
}

namespace {

std::string bar_text(const std::string& label, double share, const std::string& left) {
    constexpr int kCells = 30;
    const double done = std::clamp(share, 0.0, 1.0);
    const int filled = static_cast<int>(std::floor(done * kCells));
    std::string bar(static_cast<std::size_t>(filled), '#');
    bar.resize(kCells, '.');
    return fmt::format("{} [{}] {:3.0f} %{}{}", label, bar, std::floor(100.0 * done), left.empty() ? "" : ", ", left);
}

}  // namespace

std::string progress_text(const std::string& label, double share, double elapsed_s) {
    const double done = std::clamp(share, 0.0, 1.0);
    return bar_text(label, share, done > 0.0 ? duration_text(elapsed_s * (1.0 - done) / done) + " left" : "");
}

std::string progress_text_with(const std::string& label, double share, double left_s) {
    return bar_text(label, share, duration_text(left_s) + " left");
}

std::string duration_text(double seconds) {
    const auto whole = static_cast<long>(std::ceil(seconds));
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace stopline

// Shows the progress of long work on standard error: the share done and the remaining time. On a terminal, one line is
// redrawn. Otherwise a new line is printed every ten seconds. Nothing is shown in the first two seconds.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace stopline {

class ProgressBar {
public:
    explicit ProgressBar(std::string label);
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    ProgressBar(ProgressBar&&) = delete;
    ProgressBar& operator=(ProgressBar&&) = delete;
    ~ProgressBar();  // clears the line

    // Shows the share of the work that is done, 0 .. 1. Returns false after Ctrl-C, which tells the caller to stop.
    // Only one thread at a time may call this function.
    bool update(double share);
    // Updates the share and the label. If `remaining_s` is given, it replaces the estimate of the remaining time.
    bool update(double share, const std::string& label, std::optional<double> remaining_s);
    // Removes the line so that other text can be printed. The next update() draws the line again.
    void clear();

private:
    using Clock = std::chrono::steady_clock;

    std::string label_;
    bool is_terminal_;
    Clock::time_point begin_;
    Clock::time_point last_shown_;
    double last_share_ = 0.0;
    bool on_screen_ = false;
};

// Returns a text such as "label [#####.....]  42 %, 12 s left". The remaining time is estimated from share and elapsed
// time.
std::string progress_text(const std::string& label, double share, double elapsed_s);
// Returns a text of the same form for a known remaining time.
std::string progress_text_with_remaining(const std::string& label, double share, double remaining_s);

// Returns a duration as text, such as "8 s", "2 min 05 s" or "1 h 02 min".
std::string duration_text(double seconds);

}  // namespace stopline

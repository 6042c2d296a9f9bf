// Progress of long work on one line of standard error: a bar with share and time left, redrawn in place on a terminal; else
// a plain line every ten seconds. Work of less than two seconds shows nothing.
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

    // To be called by one thread at a time. False where the user has pressed Ctrl-C, so that it fits on_progress of the runs.
    bool update(double share);
    // The same with another label, and the time left where the caller knows it better than by the share.
    bool update(double share, const std::string& label, std::optional<double> left_s);
    void clear();  // the line, for other words; the next update draws it again

private:
    using Clock = std::chrono::steady_clock;

    std::string label_;
    bool terminal_;
    Clock::time_point begin_;
    Clock::time_point last_shown_;
    double last_share_ = 0.0;
    bool on_screen_ = false;
};

// "label [#####.....]  42 %, 12 s left"
std::string progress_text(const std::string& label, double share, double elapsed_s);
// The same where the time left is known.
std::string progress_text_with(const std::string& label, double share, double left_s);

// "8 s", "2 min 05 s", "1 h 02 min"
std::string duration_text(double seconds);

}  // namespace stopline

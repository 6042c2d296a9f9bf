// Progress of long work on standard error, with share and remaining time. On a terminal it is one line that is redrawn;
// otherwise a plain line appears every ten seconds. Work of less than two seconds shows nothing.
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

    // Shows the share done (0..1). Returns false after Ctrl-C, as the on_progress callbacks require.
    // Only one thread at a time may call it.
    bool update(double share);
    // The same with another label. `remaining_s` replaces the estimate from the share.
    bool update(double share, const std::string& label, std::optional<double> remaining_s);
    // Removes the line so that other text can be printed. The next update draws it again.
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

// Returns "label [#####.....]  42 %, 12 s left". The remaining time is estimated from share and elapsed time.
std::string progress_text(const std::string& label, double share, double elapsed_s);
// Returns the same text for a known remaining time.
std::string progress_text_with_remaining(const std::string& label, double share, double remaining_s);

// Returns "8 s", "2 min 05 s" or "1 h 02 min".
std::string duration_text(double seconds);

}  // namespace stopline

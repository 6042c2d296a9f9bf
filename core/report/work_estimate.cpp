#include "report/work_estimate.h"

#include <algorithm>

namespace stopline {

namespace {

// Expectation and observation weigh the same once this much has been seen.
constexpr double kTrust_s = 10.0;

}  // namespace

WorkEstimate::WorkEstimate(const std::vector<double>& expected_s, int threads) {
    for (const double seconds : expected_s) jobs_.push_back({seconds / std::max(1, threads), 1.0});
}

void WorkEstimate::skip(std::size_t job) { jobs_[job].left_share = 0.0; }

void WorkEstimate::begin(std::size_t job, double now_s) {
    current_ = job;
    running_ = true;
    begin_s_ = now_s;
    current_done_s_ = 0.0;
}

void WorkEstimate::stored(double share) {
    if (running_) jobs_[current_].left_share = std::min(jobs_[current_].left_share, 1.0 - share);
}

void WorkEstimate::progress(double share) {
    if (!running_) return;
    Job& job = jobs_[current_];
    const double left = std::clamp(1.0 - share, 0.0, job.left_share);
    current_done_s_ += (job.left_share - left) * job.expected_s;
    job.left_share = left;
}

void WorkEstimate::end(double now_s) {
    if (!running_) return;
    progress(1.0);
    done_s_ += current_done_s_;
    spent_s_ += now_s - begin_s_;
    running_ = false;
    current_done_s_ = 0.0;
}

double WorkEstimate::rest_s() const {
    double rest_s = 0.0;
    for (const Job& job : jobs_) rest_s += job.left_share * job.expected_s;
    return rest_s;
}

double WorkEstimate::share() const {
    const double done_s = done_s_ + current_done_s_;
    const double all_s = done_s + rest_s();
    return all_s > 0.0 ? done_s / all_s : 1.0;
}

double WorkEstimate::left_s(double now_s) const {
    const double here_s = running_ ? now_s - begin_s_ : 0.0;
    const double pace = (kTrust_s + spent_s_ + here_s) / (kTrust_s + done_s_ + current_done_s_);
    if (!running_) return rest_s() * pace;
    const Job& job = jobs_[current_];
    const double current_s = job.left_share * job.expected_s;
    const double own_pace = (kTrust_s * pace + here_s) / (kTrust_s + current_done_s_);
    return current_s * own_pace + (rest_s() - current_s) * pace;
}

}  // namespace stopline

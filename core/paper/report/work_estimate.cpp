#include "paper/report/work_estimate.h"

#include <algorithm>

namespace stopline {

namespace {

// The pace of work is its wall time divided by its expected time. The estimate is a weighted mean of an assumed pace
// and the pace of the finished work. The weight of the finished work is its expected time. The weight of the assumed
// pace is this constant.
constexpr double kPriorWeight_s = 10.0;

}  // namespace

WorkEstimate::WorkEstimate(const std::vector<double>& expected_s, int threads) {
    for (const double seconds : expected_s) jobs_.push_back({seconds / std::max(1, threads), 1.0});
}

void WorkEstimate::skip(std::size_t job) { jobs_[job].remaining_share = 0.0; }

void WorkEstimate::begin(std::size_t job, double now_s) {
    current_ = job;
    running_ = true;
    begin_s_ = now_s;
    current_done_s_ = 0.0;
}

void WorkEstimate::stored(double share) {
    if (running_) jobs_[current_].remaining_share = std::min(jobs_[current_].remaining_share, 1.0 - share);
}

void WorkEstimate::progress(double share) {
    if (!running_) return;
    Job& job = jobs_[current_];
    const double remaining = std::clamp(1.0 - share, 0.0, job.remaining_share);
    current_done_s_ += (job.remaining_share - remaining) * job.expected_s;
    job.remaining_share = remaining;
}

void WorkEstimate::end(double now_s) {
    if (!running_) return;
    progress(1.0);
    done_s_ += current_done_s_;
    spent_s_ += now_s - begin_s_;
    running_ = false;
    current_done_s_ = 0.0;
}

double WorkEstimate::remaining_expected_s() const {
    double sum_s = 0.0;
    for (const Job& job : jobs_) sum_s += job.remaining_share * job.expected_s;
    return sum_s;
}

double WorkEstimate::share() const {
    const double done_s = done_s_ + current_done_s_;
    const double total_s = done_s + remaining_expected_s();
    return total_s > 0.0 ? done_s / total_s : 1.0;
}

double WorkEstimate::remaining_s(double now_s) const {
    const double current_spent_s = running_ ? now_s - begin_s_ : 0.0;
    const double pace = (kPriorWeight_s + spent_s_ + current_spent_s) / (kPriorWeight_s + done_s_ + current_done_s_);
    if (!running_) return remaining_expected_s() * pace;
    const Job& job = jobs_[current_];
    const double current_s = job.remaining_share * job.expected_s;
    const double own_pace = (kPriorWeight_s * pace + current_spent_s) / (kPriorWeight_s + current_done_s_);
    return current_s * own_pace + (remaining_expected_s() - current_s) * pace;
}

}  // namespace stopline

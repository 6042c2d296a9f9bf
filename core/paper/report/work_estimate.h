// Estimates the share of a list of jobs that is done and the time that the rest takes. It starts from the duration of
// each job on a reference machine and corrects it with the observed progress, most of all for the current job.
#pragma once

#include <cstddef>
#include <vector>

namespace stopline {

class WorkEstimate {
public:
    // `expected_s` [job] is the duration on one thread of the reference machine.
    WorkEstimate(const std::vector<double>& expected_s, int threads);

    void skip(std::size_t job);  // marks a job that was done before this session
    void begin(std::size_t job, double now_s);
    void stored(double share);    // share of the current job that was done before this session
    void progress(double share);  // share of the current job that is done, stored share included
    void end(double now_s);       // the current job is done or has failed

    // Returns the share of this session's work that is done, 0..1.
    double share() const;
    // Returns the seconds until all jobs are done. It is never negative.
    double remaining_s(double now_s) const;

private:
    struct Job {
        double expected_s = 0.0;  // wall time expected at the start
        double remaining_share = 1.0;
    };
    double remaining_expected_s() const;  // sum over all jobs

    std::vector<Job> jobs_;
    std::size_t current_ = 0;
    bool running_ = false;
    double begin_s_ = 0.0;         // start of the current job
    double current_done_s_ = 0.0;  // work of this session on the current job, in expected seconds
    double done_s_ = 0.0;          // work of this session on the ended jobs, in expected seconds
    double spent_s_ = 0.0;         // real time spent on the ended jobs
};

}  // namespace stopline

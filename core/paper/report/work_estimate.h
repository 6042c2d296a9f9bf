// Estimates the finished share of a list of jobs, and the time that the unfinished work will take. The estimate starts
// from the duration of each job on a reference machine. The observed progress corrects the estimate, most strongly for
// the current job. A session is the time from one start of the program to its end.
#pragma once

#include <cstddef>
#include <vector>

namespace stopline {

class WorkEstimate {
public:
    // `expected_s` [job] is the duration on one thread of the reference machine.
    WorkEstimate(const std::vector<double>& expected_s, int threads);

    void skip(std::size_t job);                 // marks a job that an earlier session finished
    void begin(std::size_t job, double now_s);  // makes `job` the current job
    void stored(double share);                  // sets the share of the current job that earlier sessions finished
    void progress(double share);                // sets the finished share of the current job, earlier sessions included
    void end(double now_s);                     // ends the current job, finished or failed

    // Returns the finished share of the work of this session, 0..1.
    double share() const;
    // Returns the estimated time until all jobs are finished, s. The result is never negative.
    double remaining_s(double now_s) const;

private:
    struct Job {
        double expected_s = 0.0;  // expected wall time of the whole job
        double remaining_share = 1.0;
    };
    double remaining_expected_s() const;  // expected wall time of the unfinished work of all jobs

    std::vector<Job> jobs_;
    std::size_t current_ = 0;
    bool running_ = false;
    double begin_s_ = 0.0;         // start of the current job
    double current_done_s_ = 0.0;  // expected time of the part of the current job that this session finished
    double done_s_ = 0.0;          // expected time of the parts of ended jobs that this session finished
    double spent_s_ = 0.0;         // wall time that the ended jobs took
};

}  // namespace stopline

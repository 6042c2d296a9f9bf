// How much of a list of jobs is done and how long the rest takes. What is known beforehand is how long each job took on one machine;
// what is seen while they run corrects it, first of all for the job under way.
#pragma once

#include <cstddef>
#include <vector>

namespace stopline {

class WorkEstimate {
public:
    // `expected_s` [job]: seconds that it takes on one thread of the machine it was measured on.
    WorkEstimate(const std::vector<double>& expected_s, int threads);

    void skip(std::size_t job);  // it was done before this session
    void begin(std::size_t job, double now_s);
    void stored(double share);    // this much of the job under way was done before
    void progress(double share);  // of the job under way, what was stored included
    void end(double now_s);       // of the job under way, done or failed

    // Of what this session has to do, 0..1.
    double share() const;
    // Seconds until all is done. Never negative.
    double left_s(double now_s) const;

private:
    struct Job {
        double expected_s = 0.0;  // wall seconds, before anything was seen
        double left_share = 1.0;
    };
    double rest_s() const;  // expected, of all jobs

    std::vector<Job> jobs_;
    std::size_t current_ = 0;
    bool running_ = false;
    double begin_s_ = 0.0;         // of the job under way
    double current_done_s_ = 0.0;  // expected seconds that this session has done of it
    double done_s_ = 0.0;          // expected seconds that this session has done, of jobs that have ended
    double spent_s_ = 0.0;         // in which it did them
};

}  // namespace stopline

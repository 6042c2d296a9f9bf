#include "sweep/ranks.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/text_hash.h"
#include "runs/interrupted.h"

#ifdef STOPLINE_MPI
#include <mpi.h>
#endif

namespace stopline {

#ifdef STOPLINE_MPI

namespace {

// Message types. A worker sends `ready` at the start, `alive` every second during a run, `done` or `failed` after the
// run, and `bye` at the end. A worker sends `broken` if an exception makes all runs impossible. Rank 0 sends `run` with
// the number of a run, or `stop`.
enum Tag : int { ready, alive, done, failed, broken, bye, run, stop };

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kAlivePeriod{1};

struct Message {
    int rank = 0;
    int tag = 0;
    std::uint64_t point = 0;
    std::string text;
};

void send(int to, Tag tag, std::uint64_t point = 0, const std::string& text = {}) {
    std::string bytes(sizeof point, '\0');
    std::memcpy(bytes.data(), &point, sizeof point);
    bytes += text;
    MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, to, tag, MPI_COMM_WORLD);
}

Message receive(int from) {
    MPI_Status status;
    MPI_Probe(from, MPI_ANY_TAG, MPI_COMM_WORLD, &status);
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    std::string bytes(static_cast<std::size_t>(size), '\0');
    MPI_Recv(bytes.data(), size, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    Message message{status.MPI_SOURCE, status.MPI_TAG, 0, {}};
    std::memcpy(&message.point, bytes.data(), std::min(bytes.size(), sizeof message.point));
    message.text = bytes.substr(std::min(bytes.size(), sizeof message.point));
    return message;
}

bool has_message(int from, int tag) {
    int found = 0;
    MPI_Iprobe(from, tag, MPI_COMM_WORLD, &found, MPI_STATUS_IGNORE);
    return found != 0;
}

// Returns true if mpirun or srun started this program; both set environment variables. Otherwise the program must not
// start MPI: starting MPI takes time, and it aborts the program on machines where MPI is not set up.
bool started_by_launcher() {
    constexpr std::array kVariables{"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "PMI_SIZE"};
    return std::any_of(kVariables.begin(), kVariables.end(), [](const char* name) {
        return std::getenv(name) != nullptr;  // NOLINT(concurrency-mt-unsafe): no other thread exists yet
    });
}

// Assigns points (numbers of runs) to the workers and stores the results. Exists on rank 0 only.
class Server {
public:
    Server(int ranks, const std::vector<std::size_t>& points, RunStore& store, std::function<bool(double)> on_progress,
           double silence_max_s)
        : points_(points),
          recorder_(store, points.size(), std::move(on_progress)),
          silence_max_s_(silence_max_s),
          workers_(static_cast<std::size_t>(ranks)) {
        for (Worker& worker : workers_) worker.last_contact = Clock::now();
        workers_.front().state = State::gone;  // rank 0 is no worker
    }

    SweepSession serve() {
        while (count(State::gone) + count(State::lost) < workers_.size()) {
            if (has_message(MPI_ANY_SOURCE, MPI_ANY_TAG)) {
                handle_message(receive(MPI_ANY_SOURCE));
            } else {
                // A blocking MPI call would keep a processor busy that a worker could use.
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
                if (!recorder_.keep_going()) stopping_ = true;
                detect_lost_workers();
            }
            assign_points();
        }
        if (error_) std::rethrow_exception(error_);
        if (recorder_.stopped()) throw Interrupted();
        if (!points_left()) return recorder_.session();
        throw InputError("all worker ranks have died; finished runs are stored, repeat the command to continue");
    }

    std::size_t lost() const { return count(State::lost); }

private:
    enum class State {
        starting,   // has sent nothing yet
        waiting,    // waits for a point
        busy,       // executes the run of its point
        dismissed,  // has been sent the stop message
        gone,       // has sent the message bye
        lost        // counts as dead, because it was silent for too long
    };
    struct Worker {
        State state = State::starting;
        std::size_t point = 0;
        Clock::time_point last_contact;
    };

    std::size_t count(State state) const {
        return static_cast<std::size_t>(std::count_if(workers_.begin(), workers_.end(),
                                                      [&](const Worker& worker) { return worker.state == state; }));
    }

    bool points_left() const { return next_ < points_.size() || !reassigned_.empty(); }

    void handle_message(const Message& message) {
        Worker& worker = workers_[static_cast<std::size_t>(message.rank)];
        worker.last_contact = Clock::now();
        if (message.tag == alive) return;
        // The result of a lost worker is ignored, because its point has been assigned to another worker.
        const bool expected = worker.state == State::busy || worker.state == State::dismissed;
        worker.state = message.tag == bye ? State::gone : State::waiting;
        if (error_ || !expected || message.tag == ready || message.tag == bye) return;
        try {
            if (message.tag == broken) throw InputError(message.text);
            const auto state = message.tag == done ? PointResult::State::done : PointResult::State::failed;
            recorder_.record(message.point, {state, message.text});
        } catch (...) {
            error_ = std::current_exception();
        }
        stopping_ = stopping_ || error_ || recorder_.stopped();
    }

    // Sends points or the stop message to the workers. A worker without a point is kept waiting while other workers are
    // busy, because a busy worker may die and the point of the dead worker must then be assigned again.
    void assign_points() {
        const bool finished = !points_left() && count(State::busy) == 0;
        for (std::size_t rank = 1; rank < workers_.size(); ++rank) {
            Worker& worker = workers_[rank];
            const bool stops = stopping_ ? worker.state == State::waiting || worker.state == State::busy
                                         : finished && worker.state == State::waiting;
            if (stops) {
                worker.state = State::dismissed;
                send(static_cast<int>(rank), stop);
            } else if (!stopping_ && worker.state == State::waiting && points_left()) {
                worker.state = State::busy;
                worker.point = next_point();
                send(static_cast<int>(rank), run, worker.point);
            } else {
                continue;
            }
            worker.last_contact = Clock::now();
        }
    }

    std::size_t next_point() {
        if (reassigned_.empty()) return points_[next_++];
        const std::size_t point = reassigned_.back();
        reassigned_.pop_back();
        return point;
    }

    void detect_lost_workers() {
        const Clock::time_point now = Clock::now();
        for (Worker& worker : workers_) {
            if (worker.state != State::starting && worker.state != State::busy && worker.state != State::dismissed)
                continue;
            if (std::chrono::duration<double>(now - worker.last_contact).count() < silence_max_s_) continue;
            if (worker.state == State::busy) reassigned_.push_back(worker.point);
            worker.state = State::lost;
        }
    }

    const std::vector<std::size_t>& points_;
    SweepRecorder recorder_;
    double silence_max_s_;
    std::vector<Worker> workers_;          // [rank]
    std::size_t next_ = 0;                 // index into points_
    std::vector<std::size_t> reassigned_;  // points of lost workers, to be assigned again
    bool stopping_ = false;
    std::exception_ptr error_;
};

// Keeps in contact with rank 0 during a run of a worker. keep_going() must be called regularly: keep_going() sends the
// message `alive` every second, and returns false after the stop message of rank 0.
class Heartbeat {
public:
    bool keep_going() {
        const Clock::time_point now = Clock::now();
        if (now - last_ >= kAlivePeriod) {
            send(0, alive);
            last_ = now;
        }
        return !has_message(0, stop);
    }

private:
    Clock::time_point last_ = Clock::now();
};

}  // namespace

Ranks::Ranks() {
    if (!started_by_launcher()) return;
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    started_ = true;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
}

Ranks::~Ranks() {
    if (started_) MPI_Finalize();
}

bool Ranks::agree_on(const std::string& key) const {
    if (count_ == 1) return !key.empty();
    const std::uint64_t own = key.empty() ? 0 : hash_of(key);
    std::vector<std::uint64_t> all(static_cast<std::size_t>(count_));
    MPI_Allgather(&own, 1, MPI_UINT64_T, all.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD);
    const auto other = std::find_if(all.begin(), all.end(), [&](std::uint64_t hash) { return hash != all.front(); });
    if (other == all.end() || all.front() == 0) return own != 0 && all.front() != 0;
    if (rank_ != 0) return false;
    throw InputError(fmt::format(
        "rank {} has another sweep or program than rank 0, or cannot read it; make the files the same on all machines",
        other - all.begin()));
}

SweepSession Ranks::serve(const std::vector<std::size_t>& points, RunStore& store,
                          const std::function<bool(double)>& on_progress, double silence_max_s) {
    Server server(count_, points, store, on_progress, silence_max_s);
    try {
        SweepSession session = server.serve();
        lost_ = static_cast<int>(server.lost());
        return session;
    } catch (...) {
        lost_ = static_cast<int>(server.lost());
        throw;
    }
}

void Ranks::leave(int exit_code) const {
    if (lost_ > 0) MPI_Abort(MPI_COMM_WORLD, exit_code);
}

void Ranks::work(const Sweep& sweep) const {
    PointRunner runner(sweep);
    Heartbeat heartbeat;
    send(0, ready);
    for (Message message = receive(0); message.tag == run; message = receive(0)) {
        try {
            const PointResult result = runner.run(message.point, [&heartbeat] { return heartbeat.keep_going(); });
            // An interrupted run means that rank 0 has sent the stop message. The loop receives it next.
            if (result.state == PointResult::State::interrupted) continue;
            send(0, result.state == PointResult::State::done ? done : failed, message.point, result.text);
        } catch (const std::exception& error) {
            send(0, broken, message.point, error.what());
        }
    }
    send(0, bye);
}

#else

Ranks::Ranks() = default;
Ranks::~Ranks() = default;

bool Ranks::agree_on(const std::string& key) const { return !key.empty(); }

SweepSession Ranks::serve(const std::vector<std::size_t>& /*points*/, RunStore& /*store*/,
                          const std::function<bool(double)>& /*on_progress*/, double /*silence_max_s*/) {
    throw std::logic_error("a single rank has no workers");
}

void Ranks::work(const Sweep& /*sweep*/) const {}
void Ranks::leave(int /*exit_code*/) const {}

#endif

}  // namespace stopline

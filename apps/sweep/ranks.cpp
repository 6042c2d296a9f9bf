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
#include "experiment/interrupted.h"
#include "experiment/program_identity.h"

#ifdef STOPLINE_MPI
#include <mpi.h>
#endif

namespace stopline {

#ifdef STOPLINE_MPI

namespace {

// From a worker: ready, done, failed (that run), broken (all of it), bye. From rank 0: run, stop.
enum Tag : int { ready, done, failed, broken, bye, run, stop };

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

bool is_waiting(int from, int tag) {
    int waiting = 0;
    MPI_Iprobe(from, tag, MPI_COMM_WORLD, &waiting, MPI_STATUS_IGNORE);
    return waiting != 0;
}

// mpirun and srun tell in the environment that a program is one of several. MPI is not started without them: it takes time,
// and where it is not set up it ends the program.
bool started_by_launcher() {
    constexpr std::array kVariables{"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "PMI_SIZE"};
    return std::any_of(kVariables.begin(), kVariables.end(), [](const char* name) {
        return std::getenv(name) != nullptr;  // NOLINT(concurrency-mt-unsafe): before any thread
    });
}

// Rank 0 while the others work.
class Server {
public:
    Server(int ranks, const std::vector<std::size_t>& points, RunStore& store, std::function<bool(double)> on_progress)
        : ranks_(ranks), points_(points), recorder_(store, points.size(), std::move(on_progress)) {}

    SweepSession serve() {
        for (int working = ranks_ - 1; working > 0;) {
            if (!is_waiting(MPI_ANY_SOURCE, MPI_ANY_TAG)) {
                // Waiting in MPI would keep a processor busy that a worker could use.
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
                if (!recorder_.keep_going()) stop_all();
                continue;
            }
            const Message message = receive(MPI_ANY_SOURCE);
            if (message.tag == bye) {
                --working;
            } else {
                take(message);
                answer(message.rank);
            }
        }
        if (error_) std::rethrow_exception(error_);
        if (recorder_.stopped()) throw Interrupted();
        return recorder_.session();
    }

private:
    void take(const Message& message) {
        if (error_) return;
        try {
            if (message.tag == broken) throw InputError(message.text);
            const auto state = message.tag == done ? PointResult::State::done : PointResult::State::failed;
            if (message.tag != ready) recorder_.record(message.point, {state, message.text});
        } catch (...) {
            error_ = std::current_exception();
            stop_all();
        }
        if (recorder_.stopped()) stop_all();
    }

    void answer(int rank) {
        if (stopping_) return;  // it has been told
        if (next_ < points_.size()) {
            send(rank, run, points_[next_++]);
        } else {
            send(rank, stop);
        }
    }

    void stop_all() {
        if (stopping_) return;
        stopping_ = true;
        for (int rank = 1; rank < ranks_; ++rank) send(rank, stop);
    }

    int ranks_;
    const std::vector<std::size_t>& points_;
    SweepRecorder recorder_;
    std::size_t next_ = 0;
    bool stopping_ = false;
    std::exception_ptr error_;
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

bool Ranks::agree(const std::string& key) const {
    if (count_ == 1) return !key.empty();
    const std::uint64_t own = key.empty() ? 0 : hash_of(key);
    std::vector<std::uint64_t> all(static_cast<std::size_t>(count_));
    MPI_Allgather(&own, 1, MPI_UINT64_T, all.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD);
    const auto other = std::find_if(all.begin(), all.end(), [&](std::uint64_t hash) { return hash != all.front(); });
    if (other == all.end() || all.front() == 0) return own != 0 && all.front() != 0;
    if (rank_ != 0) return false;
    throw InputError(
        fmt::format("rank {} sees another sweep or program than rank 0, or none: are the files the same there?",
                    other - all.begin()));
}

SweepSession Ranks::serve(const std::vector<std::size_t>& points, RunStore& store,
                          const std::function<bool(double)>& on_progress) const {
    return Server(count_, points, store, on_progress).serve();
}

void Ranks::work(const Sweep& sweep) const {
    PointRunner runner(sweep);
    send(0, ready);
    for (Message message = receive(0); message.tag == run; message = receive(0)) {
        try {
            const PointResult result = runner.run(message.point, [] { return !is_waiting(0, stop); });
            if (result.state == PointResult::State::interrupted) continue;  // rank 0's stop is what comes next
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

bool Ranks::agree(const std::string& key) const { return !key.empty(); }

SweepSession Ranks::serve(const std::vector<std::size_t>& /*points*/, RunStore& /*store*/,
                          const std::function<bool(double)>& /*on_progress*/) const {
    throw std::logic_error("one rank has nobody to serve");
}

void Ranks::work(const Sweep& /*sweep*/) const {}

#endif

}  // namespace stopline

#include "common/program.h"

#include <csignal>
#include <cstdio>
#include <ctime>
#include <exception>
#include <system_error>

#include <fmt/core.h>
#include <omp.h>

#include "base/input_error.h"

namespace stopline {

namespace {

// These variables are global, because a signal handler gets no other access to data of the program.
volatile std::sig_atomic_t interrupt_received = 0;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
volatile std::sig_atomic_t interrupt_time_s = 0;    // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

std::sig_atomic_t monotonic_time_s() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<std::sig_atomic_t>(now.tv_sec);
}

// The first Ctrl-C asks the program to stop, a second Ctrl-C kills it. Wrappers such as timeout(1) send each interrupt
// twice, so the handler ignores a repetition within about two seconds.
extern "C" void on_interrupt(int signal) {
    const std::sig_atomic_t now = monotonic_time_s();
    if (interrupt_received == 0) {
        interrupt_received = 1;
        interrupt_time_s = now;
    } else if (now - interrupt_time_s > 1) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
}

ExitCode report_interrupt(const std::string& name) {
    fmt::print(stderr, "{}: interrupted; all files on disk are complete\n", name);
    return ExitCode::interrupted;
}

// Runs `body` and prints exceptions as messages.
ExitCode run_guarded(const std::string& name, const std::function<ExitCode()>& body) {
    try {
        return body();
    } catch (const InputError& error) {
        // Child processes such as gnuplot receive the same Ctrl-C and fail. This is no error of the input.
        if (interrupted()) return report_interrupt(name);
        fmt::print(stderr, "{}: {}\n", name, error.what());
        return ExitCode::bad_input;
    } catch (const Interrupted&) {
        return report_interrupt(name);
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "{}: out of memory; try fewer threads (--threads) or a shorter run\n", name);
    } catch (const std::system_error& error) {
        if (std::ferror(stdout) != 0) return ExitCode::bad_input;  // run_program() reports the failed output
        fmt::print(stderr, "{}: internal error (a bug in this program): {}\n", name, error.what());
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}: internal error (a bug in this program): {}\n", name, error.what());
    }
    return ExitCode::check_failed;
}

}  // namespace

int run_program(const std::string& name, const std::function<ExitCode()>& body) {
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGXFSZ, SIG_IGN);  // a write beyond the file size limit then fails instead of killing the program
    const ExitCode code = run_guarded(name, body);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        fmt::print(stderr, "{}: cannot write to standard output\n", name);
        if (code == ExitCode::done) return static_cast<int>(ExitCode::bad_input);
    }
    return static_cast<int>(code);
}

bool interrupted() { return interrupt_received != 0; }

int thread_count(int requested) { return requested > 0 ? requested : omp_get_max_threads(); }

}  // namespace stopline

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

// A signal handler can reach nothing but a global of this type.
volatile std::sig_atomic_t interrupt_seen = 0;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

volatile std::sig_atomic_t interrupt_second = 0;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

std::sig_atomic_t monotonic_second() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<std::sig_atomic_t>(now.tv_sec);
}

// A second Ctrl-C ends the program at once. Wrappers such as timeout(1) send one interrupt twice, to the program and to its
// group: what comes within the same or the next second is still the first.
extern "C" void on_interrupt(int signal) {
    const std::sig_atomic_t now = monotonic_second();
    if (interrupt_seen == 0) {
        interrupt_seen = 1;
        interrupt_second = now;
    } else if (now - interrupt_second > 1) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
}

ExitCode say_interrupted(const std::string& name) {
    fmt::print(stderr, "{}: interrupted; no file is half written\n", name);
    return ExitCode::interrupted;
}

ExitCode guarded(const std::string& name, const std::function<ExitCode()>& body) {
    try {
        return body();
    } catch (const InputError& error) {
        // A child that got the same Ctrl-C has not failed.
        if (interrupted()) return say_interrupted(name);
        fmt::print(stderr, "{}: {}\n", name, error.what());
        return ExitCode::bad_input;
    } catch (const Interrupted&) {
        return say_interrupted(name);
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "{}: out of memory\n", name);
    } catch (const std::system_error& error) {
        if (std::ferror(stdout) != 0) return ExitCode::bad_input;  // run_program says so
        fmt::print(stderr, "{}: internal error: {}\n", name, error.what());
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}: internal error: {}\n", name, error.what());
    }
    return ExitCode::check_failed;
}

}  // namespace

int run_program(const std::string& name, const std::function<ExitCode()>& body) {
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGXFSZ, SIG_IGN);  // writing beyond a limit on file sizes shall be an error, not the end
    const ExitCode code = guarded(name, body);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        fmt::print(stderr, "{}: cannot write to standard output\n", name);
        if (code == ExitCode::done) return static_cast<int>(ExitCode::bad_input);
    }
    return static_cast<int>(code);
}

bool interrupted() { return interrupt_seen != 0; }

int threads_or_all(int threads) { return threads > 0 ? threads : omp_get_max_threads(); }

}  // namespace stopline

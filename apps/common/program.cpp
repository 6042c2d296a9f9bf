#include "common/program.h"

#include <csignal>
#include <cstdio>
#include <ctime>
#include <exception>
#include <new>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include <omp.h>
#include <signal.h>  // SIGHUP and SIGPIPE are POSIX

#include "base/input_error.h"
#include "base/io/console.h"

namespace stopline {

namespace {

// These variables are global, because a signal handler gets no other access to data of the program.
volatile std::sig_atomic_t interrupt_signal = 0;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
volatile std::sig_atomic_t interrupt_time_s = 0;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

std::sig_atomic_t monotonic_time_s() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<std::sig_atomic_t>(now.tv_sec);
}

// The first signal asks the program to stop, a second one kills it. Wrappers such as timeout(1) send each signal twice,
// so the handler ignores a repetition within about two seconds.
extern "C" void on_interrupt(int signal) {
    const std::sig_atomic_t now = monotonic_time_s();
    if (interrupt_signal == 0) {
        interrupt_signal = signal;
        interrupt_time_s = now;
    } else if (now - interrupt_time_s > 1) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
}

// The reader of standard output has closed its pipe. The write fails as well, so later signals can be ignored.
extern "C" void on_closed_pipe(int signal) {
    if (interrupt_signal != 0) return;
    interrupt_signal = signal;
    interrupt_time_s = monotonic_time_s();
}

void install_signal_handlers() {
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
    // Signals that the caller ignores stay ignored: nohup(1) ignores SIGHUP.
    if (std::signal(SIGHUP, on_interrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
    if (std::signal(SIGPIPE, on_closed_pipe) == SIG_IGN) std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);  // a write beyond the file size limit then fails instead of killing the program
}

std::string& input_name() {
    static std::string name;
    return name;
}

ExitCode report_interrupt(const std::string& name) {
    if (interrupt_signal != SIGPIPE) print_message("{}: interrupted; all files on disk are complete\n", name);
    return ExitCode::interrupted;
}

ExitCode report_missing_memory(const std::string& name) {
    print_message(
        "{}: {}{}not enough memory. Make the input smaller, shorten the run, use fewer threads (--threads), or raise "
        "the memory limit (ulimit -v)\n",
        name, input_name(), input_name().empty() ? "" : ": ");
    return ExitCode::bad_input;
}

// Runs `body` and prints exceptions as messages.
ExitCode run_guarded(const std::string& name, const std::function<ExitCode()>& body) {
    try {
        return body();
    } catch (const InputError& error) {
        // Child processes such as gnuplot receive the same Ctrl-C and fail. This is no error of the input.
        if (interrupted()) return report_interrupt(name);
        // Messages about errors that are found after loading begin with the field. The name of the file is added here.
        const bool lacks_file = std::string_view(error.what()).starts_with("field '") && !input_name().empty();
        print_message("{}: {}{}\n", name, lacks_file ? input_name() + ": " : "", error.what());
        return ExitCode::bad_input;
    } catch (const Interrupted&) {
        return report_interrupt(name);
    } catch (const std::bad_alloc&) {
        return report_missing_memory(name);
    } catch (const std::length_error&) {  // a container would need more bytes than any computer can address
        return report_missing_memory(name);
    } catch (const std::system_error& error) {
        if (std::ferror(stdout) != 0) return ExitCode::bad_input;  // run_program() reports the failed output
        print_message("{}: internal error (a bug in this program): {}\n", name, error.what());
    } catch (const std::exception& error) {
        print_message("{}: internal error (a bug in this program): {}\n", name, error.what());
    }
    return ExitCode::check_failed;
}

}  // namespace

int run_program(const std::string& name, const std::function<ExitCode()>& body) {
    open_closed_streams();
    install_signal_handlers();
    const ExitCode code = run_guarded(name, body);
    const bool output_failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
    if (interrupt_signal == SIGPIPE && (output_failed || code == ExitCode::interrupted)) {
        std::signal(SIGPIPE, SIG_DFL);
        std::raise(SIGPIPE);  // ends the program as if it had no handler, now that its temporary files are removed
    }
    if (code == ExitCode::interrupted && interrupt_signal != 0) return 128 + interrupt_signal;
    if (output_failed) {
        print_message("{}: cannot write to standard output\n", name);
        if (code == ExitCode::done) return static_cast<int>(ExitCode::bad_input);
    }
    return static_cast<int>(code);
}

bool interrupted() { return interrupt_signal != 0; }

void end_at_once_on_termination() {
    std::signal(SIGTERM, SIG_DFL);
    if (std::signal(SIGHUP, SIG_DFL) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // as in install_signal_handlers()
}

void set_input_name(const std::string& name) { input_name() = name; }

int thread_count(int requested) { return requested > 0 ? requested : omp_get_max_threads(); }

}  // namespace stopline

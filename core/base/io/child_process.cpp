#include "base/io/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>  // declares the POSIX function kill()
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace stopline {

namespace {

constexpr int kWatchInterval_ms = 200;

// Collects the output of the program until it closes its end of the pipe. Returns false if `watch` asks to stop.
bool collect_output(int pipe, std::string& output, const ProcessWatch& watch) {
    std::array<char, 4096> buffer{};
    for (;;) {
        pollfd waiting{pipe, POLLIN, 0};
        const int ready = ::poll(&waiting, 1, watch ? kWatchInterval_ms : -1);
        if (ready < 0 && errno != EINTR) return true;
        if (ready > 0) {
            const ssize_t count = ::read(pipe, buffer.data(), buffer.size());
            if (count == 0 || (count < 0 && errno != EINTR)) return true;
            if (count > 0) output.append(buffer.data(), static_cast<std::size_t>(count));
        }
        if (watch && !watch(output)) return false;
    }
}

int wait_for(pid_t child) {
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

}  // namespace

ProcessResult run_process(std::vector<std::string> command, const std::filesystem::path& folder,
                          const ProcessWatch& watch) {
    std::array<int, 2> pipe{};
    if (::pipe2(pipe.data(), O_CLOEXEC) != 0) return {errno, 0, ""};
    std::vector<char*> argv;
    for (std::string& word : command) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, pipe[1], STDERR_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions, pipe[1], STDOUT_FILENO);
    ::posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    pid_t child = 0;
    ProcessResult result;
    result.start_error = ::posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(pipe[1]);
    if (result.start_error == 0) {
        try {
            result.stopped = !collect_output(pipe[0], result.output, watch);
        } catch (...) {
            ::kill(child, SIGKILL);
            wait_for(child);
            ::close(pipe[0]);
            throw;
        }
        if (result.stopped) ::kill(child, SIGKILL);
        result.wait_status = wait_for(child);
    }
    ::close(pipe[0]);
    return result;
}

}  // namespace stopline

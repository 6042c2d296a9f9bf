#include "base/io/console.h"

#include <fcntl.h>
#include <signal.h>  // declares the POSIX functions for signal masks
#include <unistd.h>

#include <cerrno>
#include <cstdio>

namespace stopline {

void open_closed_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
        // open() returns the smallest free number, which is `stream`, because the smaller ones are open by now.
        static_cast<void>(::open("/dev/null", stream == STDIN_FILENO ? O_RDONLY : O_WRONLY));
    }
}

// If the reader of standard error has closed its pipe, the write raises SIGPIPE in this thread. The signal is blocked
// during the write and then taken away, so that the program goes on.
void write_message(const std::string& text) {
    sigset_t closed_pipe;
    sigset_t before;
    sigemptyset(&closed_pipe);
    sigaddset(&closed_pipe, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &closed_pipe, &before);
    static_cast<void>(std::fputs(text.c_str(), stderr));
    const timespec no_wait{};
    static_cast<void>(sigtimedwait(&closed_pipe, nullptr, &no_wait));
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace stopline

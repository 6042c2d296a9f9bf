#include "base/io/console.h"

#include <fcntl.h>
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

void write_message(const std::string& text) { static_cast<void>(std::fputs(text.c_str(), stderr)); }

}  // namespace stopline

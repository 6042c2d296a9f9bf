#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "fuzz/outcome.h"

namespace stopline::fuzz {

std::filesystem::path MemoryFile::with(std::string_view content) {
    static const int kFile = memfd_create("fuzz input", 0);
    if (kFile < 0 || ftruncate(kFile, 0) != 0) fail("there is no file in memory");
    while (!content.empty()) {
        const ssize_t written = pwrite(kFile, content.data(), content.size(), lseek(kFile, 0, SEEK_END));
        if (written <= 0) fail("the file in memory cannot be written");
        content.remove_prefix(static_cast<std::size_t>(written));
    }
    return "/proc/self/fd/" + std::to_string(kFile);
}

}  // namespace stopline::fuzz

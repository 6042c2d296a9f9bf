#include "runs/program_identity.h"

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/output.h"
#include "base/version.h"

namespace stopline {

std::uint64_t hash_of(std::string_view bytes) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
    return hash;
}

std::optional<std::string> program_identity() {
    static const std::optional<std::string> identity = []() -> std::optional<std::string> {
        try {
            return fmt::format("stopline {}, program {:016x}", version(), hash_of(read_file("/proc/self/exe")));
        } catch (const InputError&) {
            return std::nullopt;
        }
    }();
    return identity;
}

}  // namespace stopline

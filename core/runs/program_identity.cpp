#include "runs/program_identity.h"

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/output.h"
#include "base/text_hash.h"
#include "base/version.h"

namespace stopline {

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

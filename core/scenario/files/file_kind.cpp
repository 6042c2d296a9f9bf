#include "scenario/files/file_kind.h"

#include <array>

#include <fmt/core.h>

#include "base/input_error.h"

namespace stopline {
namespace {

struct FileKind {
    std::string_view name;
    std::string_view field;  // a field at the top level that only files of this kind have
    std::string_view use;
};

constexpr std::array kFileKinds{
    FileKind{"scenario", "network", "run it with stopline-run"},
    FileKind{"sweep", "axes", "run it with stopline-sweep"},
    FileKind{"streets file", "intersections",
             "set network.kind: streets and network.streets: FILE in a scenario, and run that"}};

}  // namespace

void require_file_kind(const SourceNode& root, std::string_view expected) {
    const auto has_field = [&](const FileKind& kind) { return root.find(kind.field) != nullptr; };
    for (const FileKind& kind : kFileKinds) {
        if (kind.name == expected && has_field(kind)) return;
    }
    for (const FileKind& kind : kFileKinds) {
        if (kind.name == expected || !has_field(kind)) continue;
        throw InputError(fmt::format("{}: is a {}, not a {} (it has the field '{}'); {}", to_string(root.place),
                                     kind.name, expected, kind.field, kind.use));
    }
}

}  // namespace stopline

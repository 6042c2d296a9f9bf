#include "sumo/staged_folder.h"

#include <unistd.h>

#include <system_error>

#include <fmt/format.h>

#include "base/input_error.h"
#include "experiment/output.h"

namespace stopline {

namespace fs = std::filesystem;

namespace {

fs::path without_last_slash(const fs::path& folder) {
    const fs::path normal = fs::absolute(folder).lexically_normal();
    return normal.has_filename() ? normal : normal.parent_path();  // "out/"
}

}  // namespace

NewFolders::NewFolders(const fs::path& folder) {
    std::error_code ignored;
    for (fs::path each = without_last_slash(folder); !fs::exists(each, ignored) && each.has_filename();
         each = each.parent_path()) {
        made_.push_back(each);
    }
    prepare_folder(folder);
}

NewFolders::~NewFolders() {
    std::error_code ignored;
    for (const fs::path& each : made_) fs::remove(each, ignored);  // fails where it is not empty
}

StagedFolder::StagedFolder(const fs::path& folder)
    : folder_(without_last_slash(folder)), made_(folder_), stage_(folder_ / fmt::format(".{}.part", ::getpid())) {
    prepare_folder(stage_);
}

StagedFolder::~StagedFolder() {
    std::error_code ignored;
    fs::remove_all(stage_, ignored);
}

void StagedFolder::commit(const std::string& made) {
    std::error_code ignored;
    if (!fs::exists(stage_ / made)) fs::remove(folder_ / made, ignored);
    for (const fs::directory_entry& file : fs::directory_iterator(stage_)) {
        const fs::path target = folder_ / file.path().filename();
        std::error_code error;
        fs::rename(file.path(), target, error);
        if (error) throw InputError(fmt::format("{}: cannot write: {}", target.string(), error.message()));
    }
}

}  // namespace stopline

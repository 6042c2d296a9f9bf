#include "sumo/staged_folder.h"

#include <unistd.h>

#include <system_error>

#include <fmt/format.h>

#include "base/input_error.h"
#include "experiment/output.h"

namespace stopline {

namespace fs = std::filesystem;

StagedFolder::StagedFolder(const fs::path& folder) : folder_(fs::absolute(folder).lexically_normal()) {
    if (!folder_.has_filename()) folder_ = folder_.parent_path();  // "out/"
    std::error_code ignored;
    for (fs::path each = folder_; !fs::exists(each, ignored) && each.has_filename(); each = each.parent_path()) {
        made_.push_back(each);
    }
    prepare_folder(folder_);
    stage_ = folder_ / fmt::format(".{}.part", ::getpid());
    prepare_folder(stage_);
}

StagedFolder::~StagedFolder() {
    std::error_code ignored;
    fs::remove_all(stage_, ignored);
    for (const fs::path& each : made_) fs::remove(each, ignored);  // as far as they are empty
}

void StagedFolder::commit() {
    for (const fs::directory_entry& file : fs::directory_iterator(stage_)) {
        const fs::path target = folder_ / file.path().filename();
        std::error_code error;
        fs::rename(file.path(), target, error);
        if (error) throw InputError(fmt::format("{}: cannot write: {}", target.string(), error.message()));
    }
    made_.clear();
}

}  // namespace stopline

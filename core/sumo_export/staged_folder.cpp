#include "sumo_export/staged_folder.h"

#include <system_error>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/output.h"
#include "base/io/replaced_file.h"

namespace stopline {

namespace fs = std::filesystem;

namespace {

fs::path without_last_slash(const fs::path& folder) {
    const fs::path normal = fs::absolute(folder).lexically_normal();
    return normal.has_filename() ? normal : normal.parent_path();
}

}  // namespace

NewFolders::NewFolders(const fs::path& folder) {
    std::error_code ignored;
    for (fs::path parent = without_last_slash(folder); !fs::exists(parent, ignored) && parent.has_filename();
         parent = parent.parent_path()) {
        created_.push_back(parent);
    }
    prepare_folder(folder);
}

NewFolders::~NewFolders() {
    std::error_code ignored;
    for (const fs::path& created : created_) fs::remove(created, ignored);  // fails if the folder is not empty
}

StagedFolder::StagedFolder(const fs::path& folder)
    : folder_(without_last_slash(folder)), new_folders_(folder_), stage_(temporary_path(folder_ / "files")) {
    prepare_folder(stage_);
}

StagedFolder::~StagedFolder() {
    std::error_code ignored;
    fs::remove_all(stage_, ignored);
}

void StagedFolder::commit(const std::string& derived_file) {
    std::error_code ignored;
    if (!fs::exists(stage_ / derived_file)) fs::remove(folder_ / derived_file, ignored);
    for (const fs::directory_entry& file : fs::directory_iterator(stage_)) {
        const fs::path target = folder_ / file.path().filename();
        std::error_code error;
        fs::rename(file.path(), target, error);
        if (error)
            throw InputError(fmt::format("{}: the file cannot be written: {}", target.string(), error.message()));
    }
}

}  // namespace stopline

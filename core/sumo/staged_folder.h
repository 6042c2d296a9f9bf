// Files that come into their folder together once all of them are made. A program that fails or is interrupted leaves the folder as it
// was, or as little there as before.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stopline {

// Makes a folder, with its parents, if need be. At the end those of them that it made, and that are still empty, are taken away.
class NewFolders {
public:
    // Throws InputError with path and reason.
    explicit NewFolders(const std::filesystem::path& folder);
    NewFolders(const NewFolders&) = delete;
    NewFolders& operator=(const NewFolders&) = delete;
    NewFolders(NewFolders&&) = delete;
    NewFolders& operator=(NewFolders&&) = delete;
    ~NewFolders();

private:
    std::vector<std::filesystem::path> made_;  // the innermost first
};

class StagedFolder {
public:
    // Makes the folder, with its parents, if need be. This and commit throw InputError with path and reason.
    explicit StagedFolder(const std::filesystem::path& folder);
    StagedFolder(const StagedFolder&) = delete;
    StagedFolder& operator=(const StagedFolder&) = delete;
    StagedFolder(StagedFolder&&) = delete;
    StagedFolder& operator=(StagedFolder&&) = delete;
    ~StagedFolder();

    // Where to write: a hidden folder in the other.
    const std::filesystem::path& path() const { return stage_; }
    // Moves the files to their places, where they replace those of their names. `made`: what may be there of an earlier time, made of
    // files that are replaced now; it is taken away unless it is among them.
    void commit(const std::string& made);

private:
    std::filesystem::path folder_;
    NewFolders made_;
    std::filesystem::path stage_;
};

}  // namespace stopline

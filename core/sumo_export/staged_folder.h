// Puts files into a folder together, once all of them are complete. A program that fails or is interrupted leaves the
// folder unchanged.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stopline {

// Creates a folder and its parents. The destructor removes the folders that it created if they are still empty.
class NewFolders {
public:
    // Throws InputError with path and reason if a folder cannot be created.
    explicit NewFolders(const std::filesystem::path& folder);
    NewFolders(const NewFolders&) = delete;
    NewFolders& operator=(const NewFolders&) = delete;
    NewFolders(NewFolders&&) = delete;
    NewFolders& operator=(NewFolders&&) = delete;
    ~NewFolders();

private:
    std::vector<std::filesystem::path> created_;  // the innermost folder first
};

class StagedFolder {
public:
    // Creates the folder and its parents. Throws InputError with path and reason.
    explicit StagedFolder(const std::filesystem::path& folder);
    StagedFolder(const StagedFolder&) = delete;
    StagedFolder& operator=(const StagedFolder&) = delete;
    StagedFolder(StagedFolder&&) = delete;
    StagedFolder& operator=(StagedFolder&&) = delete;
    ~StagedFolder();

    // Returns the folder to write into: a hidden folder inside the target folder.
    const std::filesystem::path& path() const { return stage_; }
    // Moves the files into the target folder, where they replace files of the same names. `derived_file` is built from
    // the other files; an earlier version of it is removed if there is no new one. Throws InputError with path and
    // reason.
    void commit(const std::string& derived_file);

private:
    std::filesystem::path folder_;
    NewFolders new_folders_;
    std::filesystem::path stage_;
};

}  // namespace stopline

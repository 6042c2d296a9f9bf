// Writes several files into a folder so that they appear together, after all of them are complete. A program that fails
// or is interrupted leaves the folder unchanged.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stopline {

// Creates a folder and its parents. The destructor removes those of the created folders that are still empty.
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
    std::vector<std::filesystem::path> created_;  // folders that did not exist before, the innermost folder first
};

class StagedFolder {
public:
    // Creates the folder and its parents. Throws InputError with path and reason if a folder cannot be created.
    explicit StagedFolder(const std::filesystem::path& folder);
    StagedFolder(const StagedFolder&) = delete;
    StagedFolder& operator=(const StagedFolder&) = delete;
    StagedFolder(StagedFolder&&) = delete;
    StagedFolder& operator=(StagedFolder&&) = delete;
    ~StagedFolder();

    // Returns the folder into which the caller writes the files. It is a hidden folder inside the target folder.
    const std::filesystem::path& path() const { return stage_; }
    // Moves the files into the target folder, where they replace files of the same names. `derived_file` names a file
    // that is built from the other files. If the caller has not written this file, an old version of the file in the
    // target folder is removed. Throws InputError with path and reason if a file cannot be moved.
    void commit(const std::string& derived_file);

private:
    std::filesystem::path folder_;
    NewFolders new_folders_;
    std::filesystem::path stage_;
};

}  // namespace stopline

// Joins the stores of shards.
#pragma once

#include <filesystem>
#include <vector>

#include "experiment/sweep_results.h"

namespace stopline {

struct MergedSweep {
    std::string name;
    SweepTable table;
};

// Writes NAME.csv, NAME.provenance.json and the joined store NAME.sqlite into the folder, as if the sweep had been run there
// in one. Throws InputError, and writes nothing, where the stores are not of the same sweep and program, where two of them
// have the same run, or where runs are missing.
MergedSweep merge_stores(const std::vector<std::filesystem::path>& files, const std::filesystem::path& folder);

// The names of a sweep's files in a folder.
struct SweepFiles {
    std::filesystem::path store;
    std::filesystem::path table;
    std::filesystem::path provenance;
};
SweepFiles sweep_files(const std::filesystem::path& folder, const std::string& name, const Shard& shard = {});

}  // namespace stopline

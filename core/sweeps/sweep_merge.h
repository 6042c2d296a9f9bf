// Joins the stores of the shards of a sweep.
#pragma once

#include <filesystem>
#include <vector>

#include "runs/tables/column_aliases.h"
#include "sweeps/sweep_results.h"

namespace stopline {

struct MergedSweep {
    std::string name;
    SweepTable table;
};

// Writes NAME.csv, NAME.provenance.json and the joined store NAME.sqlite into the folder, as one run of the whole sweep
// does. Throws InputError and writes nothing if the stores belong to different sweeps or programs, if two of them hold
// the same run, or if runs are missing.
MergedSweep merge_stores(const std::vector<std::filesystem::path>& files, const std::filesystem::path& folder,
                         ColumnNames names = ColumnNames::current);

// The files of a sweep in a folder.
struct SweepFiles {
    std::filesystem::path store;
    std::filesystem::path table;
    std::filesystem::path provenance;
};
SweepFiles sweep_files(const std::filesystem::path& folder, const std::string& name, const Shard& shard = {});

}  // namespace stopline

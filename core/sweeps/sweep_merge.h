// Merges the stores of all shards of a sweep into one store and one result table.
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

// Writes NAME.csv, NAME.provenance.json and the merged store NAME.sqlite into the folder, as a sweep without shards
// does. Throws InputError and writes nothing if the stores belong to different sweeps or programs, if two of them hold
// the same run, if runs are missing, or if NAME.sqlite exists.
MergedSweep merge_stores(const std::vector<std::filesystem::path>& files, const std::filesystem::path& folder,
                         ColumnNames names = ColumnNames::current);

// The paths of the files that a sweep or one of its shards writes.
struct SweepFiles {
    std::filesystem::path store;
    std::filesystem::path table;
    std::filesystem::path provenance;
};
SweepFiles sweep_files(const std::filesystem::path& folder, const std::string& name, const Shard& shard = {});

}  // namespace stopline

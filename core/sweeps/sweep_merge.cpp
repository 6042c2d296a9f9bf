#include "sweeps/sweep_merge.h"

#include <system_error>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/output.h"
#include "base/io/replaced_file.h"

namespace stopline {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kRangesShown = 8;

void require_same(const RunStore& first, const RunStore& other) {
    const StoreIdentity& a = first.identity();
    const StoreIdentity& b = other.identity();
    const char* const difference = a.name != b.name                             ? "they are of different sweeps"
                                   : a.sweep != b.sweep || a.points != b.points ? "their sweeps or scenarios differ"
                                   : a.program != b.program ? "different builds of the program made them"
                                                            : nullptr;
    if (difference == nullptr) return;
    throw InputError(
        fmt::format("{} and {} cannot be joined: {}", first.file().string(), other.file().string(), difference));
}

// Returns sorted points as text, such as "3, 7-12, 20 and 5 more".
std::string ranges_text(const std::vector<std::size_t>& points) {
    std::string text;
    std::size_t shown = 0;
    std::size_t i = 0;
    for (; i < points.size() && shown < kRangesShown; ++shown) {
        std::size_t last = i;
        while (last + 1 < points.size() && points[last + 1] == points[last] + 1) ++last;
        text += text.empty() ? "" : ", ";
        text += last == i ? fmt::format("{}", points[i]) : fmt::format("{}-{}", points[i], points[last]);
        i = last + 1;
    }
    return text + (i < points.size() ? fmt::format(" and {} more", points.size() - i) : "");
}

// Throws InputError if two stores hold the same run, or if runs are missing.
void check_completeness(const std::vector<RunStore>& stores) {
    constexpr std::size_t kNoStore = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> owner(stores.front().identity().points, kNoStore);
    for (std::size_t k = 0; k < stores.size(); ++k) {
        const std::vector<bool> done = stores[k].done();
        for (std::size_t point = 0; point < done.size(); ++point) {
            if (!done[point]) continue;
            if (owner[point] != kNoStore) {
                throw InputError(fmt::format("{} and {} overlap: both have run {}",
                                             stores[owner[point]].file().string(), stores[k].file().string(), point));
            }
            owner[point] = k;
        }
    }
    std::vector<std::size_t> missing;
    for (std::size_t point = 0; point < owner.size(); ++point) {
        if (owner[point] == kNoStore) missing.push_back(point);
    }
    if (missing.empty()) return;
    throw InputError(fmt::format(
        "{} of {} runs are missing: {}. Add the missing stores, or start unfinished shards again; they continue",
        missing.size(), owner.size(), ranges_text(missing)));
}

// Writes the runs of all stores into a new store.
void join(const std::vector<RunStore>& stores, const fs::path& file) {
    StoreIdentity identity = stores.front().identity();
    identity.shard.clear();
    RunStore joined = RunStore::open_or_make(file, identity);
    joined.put_in_one_transaction([&] {
        for (const RunStore& store : stores) {
            store.for_each_run([&](std::size_t point, const std::string& result) { joined.put(point, result); });
        }
    });
}

}  // namespace

SweepFiles sweep_files(const fs::path& folder, const std::string& name, const Shard& shard) {
    const std::string part = shard.count > 1 ? fmt::format(".shard-{}-of-{}", shard.index, shard.count) : "";
    return {folder / (name + part + ".sqlite"), folder / (name + part + ".csv"),
            folder / (name + part + ".provenance.json")};
}

MergedSweep merge_stores(const std::vector<fs::path>& files, const fs::path& folder, ColumnNames names) {
    if (files.empty()) throw InputError("merge: no stores given");
    std::vector<RunStore> stores;
    for (const fs::path& file : files) {
        for (const RunStore& other : stores) {
            std::error_code ignored;
            if (fs::equivalent(other.file(), file, ignored)) {
                throw InputError(fmt::format("{} is given twice", file.string()));
            }
        }
        stores.push_back(RunStore::open(file));
        require_same(stores.front(), stores.back());
    }
    check_completeness(stores);
    const std::string& name = stores.front().identity().name;
    const SweepFiles results = sweep_files(folder, name);
    if (fs::exists(results.store)) {
        throw InputError(
            fmt::format("{}: the store exists already: choose another --output, or remove it", results.store.string()));
    }
    // The merged store gets its final name only when it is complete.
    const fs::path temporary = temporary_path(results.store);
    std::error_code ignored;
    MergedSweep merged{name, {}};
    try {
        fs::remove(temporary, ignored);  // a file that a killed program may have left
        join(stores, temporary);
        merged.table = sweep_results(RunStore::open(temporary));
        write_file(results.table, result_file("sweep/NAME.csv", "", merged.table.csv, names).text);
        write_file(results.provenance, stores.front().identity().provenance);
        fs::rename(temporary, results.store);  // the last action, so that a killed merge can be repeated
    } catch (...) {
        for (const char* const suffix : {"", "-wal", "-journal"}) fs::remove(temporary.string() + suffix, ignored);
        throw;
    }
    return merged;
}

}  // namespace stopline

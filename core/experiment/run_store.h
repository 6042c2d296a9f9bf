// Where a sweep keeps its finished runs: an SQLite file, each run in a transaction of its own. A program that is killed at any
// moment leaves a file that holds every run that was put before, whole.
//
// One program at a time: the file is locked for as long as it is open. That lock is also what lets SQLite's write-ahead log
// work without memory shared between programs, which the network file systems of clusters do not have. With the log a run
// costs no wait for the disk; a power cut may take the last runs, which are then run again, but never the file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

struct sqlite3;

namespace stopline {

// Whose runs a store holds. Two stores can be joined, and a store can be continued, only where all of it but the shard agrees.
struct StoreIdentity {
    std::string name;        // of the sweep
    std::string sweep;       // Sweep::key()
    std::string program;     // program_identity()
    std::size_t points = 0;  // of the whole sweep
    std::string shard;       // "2/8", or "" for all points
    std::string provenance;  // JSON text that goes beside the table of results
};

class RunStore {
public:
    // Opens the store, or makes it. Throws InputError with the path where it belongs to another sweep, to the same sweep
    // with other parameters, to another build of the program, or to nobody; or where another program has it open.
    static RunStore open_or_make(const std::filesystem::path& file, const StoreIdentity& identity);
    // Opens one that is there.
    static RunStore open(const std::filesystem::path& file);

    const StoreIdentity& identity() const { return identity_; }
    const std::filesystem::path& file() const { return file_; }

    std::vector<bool> done() const;  // [point]
    // Throws InputError where it cannot be written (a full disk); what was there before stays. Not for two threads at a time.
    void put(std::size_t point, const std::string& result);
    // All runs in the order of their points.
    void each(const std::function<void(std::size_t point, const std::string& result)>& visit) const;

    // Everything that is put meanwhile becomes one transaction.
    void put_all(const std::function<void()>& puts);

private:
    struct Close {
        void operator()(sqlite3* database) const;
    };

    RunStore(std::filesystem::path file, bool make);
    void execute(const char* sql) const;
    [[noreturn]] void fail(int code) const;
    bool has_tables() const;
    void make_tables(const StoreIdentity& identity);
    void read_identity();

    std::filesystem::path file_;
    std::unique_ptr<sqlite3, Close> database_;
    StoreIdentity identity_;
};

}  // namespace stopline

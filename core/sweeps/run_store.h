// Stores the finished runs of a sweep in an SQLite file, each run in a transaction of its own. If the program is killed
// at any moment, the file still holds every run stored before.
//
// Only one program can open the file at a time. With this lock, SQLite's write-ahead log needs no memory shared between
// programs, which network file systems of clusters do not offer. With the log, storing a run does not wait for the
// disk. A power cut can lose the last runs, which are then run again, but never damages the file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

struct sqlite3;

namespace stopline {

// Identifies the runs of a store. A store is continued only by the same sweep, program and shard. Stores are joined
// only if everything but the shard is the same.
struct StoreIdentity {
    std::string name;        // name of the sweep
    std::string sweep;       // Sweep::key()
    std::string program;     // program_identity()
    std::size_t points = 0;  // number of runs of the whole sweep
    std::string shard;       // "2/8"; empty: all points
    std::string provenance;  // JSON text that is written beside the result table
};

class RunStore {
public:
    // Opens the store, or creates it. Throws InputError with the path if it belongs to another sweep, to other
    // parameters or to another build of the program, if it is not a store, or if another program has it open.
    static RunStore open_or_make(const std::filesystem::path& file, const StoreIdentity& identity);
    // Opens an existing store. Throws InputError if the file is missing or is not a store.
    static RunStore open(const std::filesystem::path& file);

    const StoreIdentity& identity() const { return identity_; }
    const std::filesystem::path& file() const { return file_; }

    std::vector<bool> done() const;  // [point] true: the run is stored
    // Stores a run. Throws InputError if it cannot be written; the stored runs remain. Must not be called by two
    // threads at the same time.
    void put(std::size_t point, const std::string& result);
    // Calls visit for all runs in the order of their points.
    void for_each_run(const std::function<void(std::size_t point, const std::string& result)>& visit) const;

    // Makes one transaction of all runs that `puts` stores.
    void put_in_one_transaction(const std::function<void()>& puts);

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

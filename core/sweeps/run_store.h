// Stores the finished runs of a sweep in an SQLite file, each run in a transaction of its own. If the program is
// killed, the file still holds every run that was stored before.
//
// Only one program at a time can open the file. Several programs would need shared memory to use SQLite's write-ahead
// log together, and the network file systems of clusters do not offer shared memory. With this log, storing a run does
// not wait for the disk. A power cut can lose the last runs, but does not damage the file. The sweep then repeats these
// runs.
//
// Each run has a checksum, and opening a store checks all of them and the structure of the file. A damaged store is
// refused, so a table never has wrong numbers.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

struct sqlite3;

namespace stopline {

// Identifies the runs in a store. A store is continued only by the same sweep, program and shard. Stores are merged
// only if they belong to the same sweep and program.
struct StoreIdentity {
    std::string name;        // name of the sweep
    std::string sweep;       // result of Sweep::key()
    std::string program;     // result of program_identity()
    std::size_t points = 0;  // number of runs of the whole sweep
    std::string shard;       // shard of the sweep, such as "2/8"; empty: the whole sweep
    std::string provenance;  // text of the file NAME.provenance.json, which lies beside the result table
};

// A store of runs. The parameter `point` is the number of a run in its sweep, see sweep.h.
class RunStore {
public:
    // Opens the store in `file`, or creates it. Throws InputError if the stored identity differs from `identity` in
    // anything but the provenance. Also throws InputError if the file is not a store of this version, if it is damaged,
    // or if another program has it open.
    static RunStore open_or_make(const std::filesystem::path& file, const StoreIdentity& identity);
    // Opens an existing store. Throws InputError if the file is missing, is not a store of this version, is damaged, or
    // is open in another program.
    static RunStore open(const std::filesystem::path& file);
    // Returns true if the store belongs to another sweep, to another program or to another version of the store. Throws
    // InputError if the file is not a store, is damaged, or is open in another program.
    static bool is_outdated(const std::filesystem::path& file, const StoreIdentity& identity);

    const StoreIdentity& identity() const { return identity_; }
    const std::filesystem::path& file() const { return file_; }

    std::vector<bool> done() const;  // [point] true: the store holds the run
    // Stores the result of a run. Throws InputError if it cannot be written; runs that are already stored remain. Must
    // not be called by two threads at the same time.
    void put(std::size_t point, const std::string& result);
    // Calls visit() for all stored runs, in ascending order of `point`.
    void for_each_run(const std::function<void(std::size_t point, const std::string& result)>& visit) const;

    // Calls `puts`. All runs that `puts` passes to put() are stored in a single transaction.
    void put_in_one_transaction(const std::function<void()>& puts);

private:
    struct Close {
        void operator()(sqlite3* database) const;
    };

    RunStore(std::filesystem::path file, bool make);
    void execute(const char* sql) const;
    [[noreturn]] void fail(int code) const;
    [[noreturn]] void fail_damaged(const std::string& damage) const;
    bool has_tables() const;
    void make_tables(const StoreIdentity& identity);
    std::map<std::string, std::string> meta_rows() const;
    void read_identity();
    // Throws InputError unless the whole file is in order and every run matches its checksum.
    void check_integrity() const;

    std::filesystem::path file_;
    std::unique_ptr<sqlite3, Close> database_;
    StoreIdentity identity_;
};

}  // namespace stopline

// The store keeps finished runs. It can be used only with the sweep and the program that created it.
#include "sweeps/run_store.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <map>

#include "scenario/scenario_text.h"

namespace stopline {
namespace {

StoreIdentity identity() { return {"green", "00ff", "stopline 0.1, program 1", 5, "", "{}\n"}; }

std::map<std::size_t, std::string> runs_in(const RunStore& store) {
    std::map<std::size_t, std::string> runs;
    store.for_each_run([&](std::size_t point, const std::string& result) { runs[point] = result; });
    return runs;
}

class RunStoreTest : public ::testing::Test {
protected:
    std::string open_error(const StoreIdentity& wanted) const {
        return input_error_of([&] { static_cast<void>(RunStore::open_or_make(file_, wanted)); });
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_.path() / "green.sqlite";
};

TEST_F(RunStoreTest, KeepsRuns) {
    {
        RunStore store = RunStore::open_or_make(file_, identity());
        EXPECT_EQ(store.done(), std::vector<bool>(5, false));
        store.put(3, "a=1\n");
        store.put(0, std::string("b=\xc3\xa4 ' \n"));
    }
    const RunStore reopened = RunStore::open_or_make(file_, identity());
    EXPECT_EQ(reopened.done(), (std::vector<bool>{true, false, false, true, false}));
    EXPECT_EQ(runs_in(reopened), (std::map<std::size_t, std::string>{{0, "b=\xc3\xa4 ' \n"}, {3, "a=1\n"}}));
    EXPECT_EQ(reopened.identity().provenance, "{}\n");
}

TEST_F(RunStoreTest, BelongsToOneSweepProgramAndShard) {
    static_cast<void>(RunStore::open_or_make(file_, identity()));
    StoreIdentity other = identity();
    other.sweep = "0100";
    EXPECT_TRUE(contains(open_error(other), "has changed since"));
    EXPECT_TRUE(contains(open_error(other), file_.string()));
    other = identity();
    other.points = 6;
    EXPECT_TRUE(contains(open_error(other), "has changed since"));
    other = identity();
    other.program = "stopline 0.1, program 2";
    EXPECT_TRUE(contains(open_error(other), "another build of the program"));
    other = identity();
    other.name = "red";
    EXPECT_TRUE(contains(open_error(other), "of the sweep 'green'"));
    other = identity();
    other.shard = "1/2";
    EXPECT_TRUE(contains(open_error(other), "shard 1/1"));
    EXPECT_EQ(open_error(identity()), "");
}

TEST_F(RunStoreTest, IsLockedWhileAProgramHasItOpen) {
    const RunStore store = RunStore::open_or_make(file_, identity());
    EXPECT_TRUE(contains(open_error(identity()), "another program has this store open"));
    EXPECT_TRUE(contains(input_error_of([&] { static_cast<void>(RunStore::open(file_)); }), "another program"));
}

// Executes SQL on the file, as damage that SQLite itself cannot notice.
void change(const std::filesystem::path& file, const char* sql) {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(database);
    sqlite3_close(database);
}

TEST_F(RunStoreTest, RefusesRunsThatDoNotMatchTheirChecksum) {
    const char* const changes[] = {"UPDATE runs SET result = 'a=2' || char(10) WHERE point = 3",
                                   "UPDATE runs SET point = 2 WHERE point = 3",
                                   "UPDATE runs SET point = 5 WHERE point = 3",
                                   "UPDATE runs SET point = -1 WHERE point = 3",
                                   "UPDATE runs SET checksum = '' WHERE point = 3",
                                   "UPDATE runs SET result = CAST(result AS BLOB) WHERE point = 3",
                                   "UPDATE meta SET value = '6' WHERE key = 'points'",
                                   "UPDATE meta SET value = 'x' WHERE key = 'provenance'"};
    for (const char* const sql : changes) {
        std::filesystem::remove(file_);
        {
            RunStore store = RunStore::open_or_make(file_, identity());
            store.put(1, "a=0\n");
            store.put(3, "a=1\n");
        }
        change(file_, sql);
        EXPECT_TRUE(contains(open_error(identity()), "the store is damaged: ")) << sql << "\n"
                                                                                << open_error(identity());
        EXPECT_TRUE(contains(open_error(identity()), file_.string() + ": ")) << sql;
        EXPECT_TRUE(contains(input_error_of([&] { static_cast<void>(RunStore::open(file_)); }), "damaged")) << sql;
    }
}

TEST_F(RunStoreTest, RefusesAnotherVersionOfTheStore) {
    static_cast<void>(RunStore::open_or_make(file_, identity()));
    EXPECT_FALSE(RunStore::is_outdated(file_, identity()));
    StoreIdentity other = identity();
    other.program = "stopline 0.1, program 2";
    EXPECT_TRUE(RunStore::is_outdated(file_, other));
    change(file_, "UPDATE meta SET value = 'stopline runs 1' WHERE key = 'format'");
    EXPECT_TRUE(contains(open_error(identity()), "another version of the program wrote this store"));
    EXPECT_TRUE(contains(open_error(identity()), "'stopline runs 1'"));
    EXPECT_TRUE(RunStore::is_outdated(file_, identity()));
}

TEST_F(RunStoreTest, RefusesOtherFiles) {
    EXPECT_TRUE(contains(input_error_of([&] { static_cast<void>(RunStore::open(file_)); }), "no such file"));
    folder_.write("green.sqlite", std::string(5000, 'x'));
    EXPECT_TRUE(contains(open_error(identity()), "not a store"));
    std::filesystem::remove(file_);
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(file_.c_str(), &database), SQLITE_OK);
    sqlite3_exec(database, "CREATE TABLE meta(key TEXT, value TEXT)", nullptr, nullptr, nullptr);
    sqlite3_close(database);
    EXPECT_TRUE(contains(open_error(identity()), "not a store"));
    std::filesystem::remove(file_);
    std::filesystem::create_directory(file_);
    EXPECT_TRUE(contains(open_error(identity()), file_.string()));
}

TEST_F(RunStoreTest, AcceptsAnEmptyFileAsANewStore) {
    folder_.write("green.sqlite", "");
    EXPECT_EQ(open_error(identity()), "")
        << "a program that is killed before its first transaction leaves an empty file";
}

TEST_F(RunStoreTest, TransactionStoresAllRunsOrNone) {
    {
        RunStore store = RunStore::open_or_make(file_, identity());
        EXPECT_THROW(store.put_in_one_transaction([&] {
            store.put(1, "x=1\n");
            throw std::runtime_error("failure within the transaction");
        }),
                     std::runtime_error);
    }
    RunStore store = RunStore::open(file_);
    EXPECT_TRUE(runs_in(store).empty());
    store.put_in_one_transaction([&] {
        store.put(1, "x=1\n");
        store.put(2, "x=2\n");
    });
    EXPECT_EQ(runs_in(store).size(), 2U);
    EXPECT_TRUE(contains(input_error_of([&] { store.put(1, "x=3\n"); }), "UNIQUE")) << "a run is never replaced";
}

}  // namespace
}  // namespace stopline

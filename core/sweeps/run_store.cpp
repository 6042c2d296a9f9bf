#include "sweeps/run_store.h"

#include <sqlite3.h>

#include <new>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/text_hash.h"
#include "scenario/schema/quantity.h"

namespace stopline {

namespace {

// Stores of another format are refused.
constexpr std::string_view kFormat = "stopline runs 2";
constexpr const char* kChecksumRow = "checksum";
constexpr std::string_view kFormatOfAnyVersion = "stopline runs ";

// A prepared SQLite statement. The destructor finalises it.
class Statement {
public:
    Statement(sqlite3* database, const char* sql)
        : code_(sqlite3_prepare_v2(database, sql, -1, &statement_, nullptr)) {}
    Statement(const Statement&) = delete;
    Statement& operator=(const Statement&) = delete;
    Statement(Statement&&) = delete;
    Statement& operator=(Statement&&) = delete;
    ~Statement() { sqlite3_finalize(statement_); }

    void bind(int index, const std::string& text) {
        if (code_ != SQLITE_OK) return;
        // The null pointer tells SQLite not to copy the text, because the caller keeps the text until the statement has
        // run.
        code_ = sqlite3_bind_text64(statement_, index, text.data(), text.size(), nullptr, SQLITE_UTF8);
    }
    void bind(int index, std::size_t number) {
        if (code_ == SQLITE_OK) code_ = sqlite3_bind_int64(statement_, index, static_cast<sqlite3_int64>(number));
    }
    // Returns SQLITE_ROW, SQLITE_DONE or an error code. If an earlier call has failed, returns the error code of that
    // earlier call.
    int step() { return code_ == SQLITE_OK ? sqlite3_step(statement_) : code_; }

    std::string text(int column) const {
        const void* const bytes = sqlite3_column_blob(statement_, column);
        const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, column));
        return bytes == nullptr ? std::string() : std::string(static_cast<const char*>(bytes), size);
    }
    std::size_t number(int column) const { return static_cast<std::size_t>(sqlite3_column_int64(statement_, column)); }
    bool is_number(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_INTEGER; }
    bool is_text(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_TEXT; }

private:
    sqlite3_stmt* statement_ = nullptr;
    int code_;
};

std::string reason(int code, sqlite3* database) {
    const int kind = code & 0xff;
    if (kind == SQLITE_BUSY || kind == SQLITE_LOCKED) return "another program has this store open; wait until it ends";
    if (kind == SQLITE_NOTADB || kind == SQLITE_CORRUPT)
        return "the file is not a store of stopline-sweep, or it is damaged. Check the path. If it is a damaged store, "
               "remove it and repeat the sweep";
    if (kind == SQLITE_FULL) return "cannot write: the disk is full";
    if (kind == SQLITE_READONLY || kind == SQLITE_CANTOPEN || kind == SQLITE_PERM || kind == SQLITE_IOERR) {
        return fmt::format(
            "cannot write to the store: the file or its folder is read-only, or the disk fails (SQLite: {}, {}). Copy "
            "a read-only store to another folder first",
            sqlite3_errstr(code), code);
    }
    const std::string message = database == nullptr ? sqlite3_errstr(code) : sqlite3_errmsg(database);
    return fmt::format("the store cannot be used: {} ({})", message, code);
}

std::string checksum_of(std::string_view text) { return fmt::format("{:016x}", hash_of(text)); }

// The checksum of a run covers its number, so that exchanged runs are noticed.
std::string checksum_of_run(std::size_t point, const std::string& result) {
    return checksum_of(fmt::format("{}\n{}", point, result));
}

using MetaRows = std::map<std::string, std::string>;

// Returns the checksum of all rows of the table `meta` except the row with the checksum itself.
std::string checksum_of_meta(const MetaRows& rows) {
    std::string text;
    for (const auto& [key, value] : rows) {
        if (key != kChecksumRow) text += key + "=" + value + "\n";
    }
    return checksum_of(text);
}

// Returns a text about the first difference between two identities; "" if they are equal. The provenance is not
// compared.
std::string difference_of(const StoreIdentity& has, const StoreIdentity& wanted) {
    if (has.name != wanted.name) return fmt::format("it holds runs of the sweep '{}'", has.name);
    if (has.sweep != wanted.sweep || has.points != wanted.points) {
        return "the sweep, its scenario or a file that they use has changed since the store was created";
    }
    if (has.program != wanted.program) {
        return fmt::format("another build of the program made its runs ({})", has.program);
    }
    if (has.shard != wanted.shard) {
        return fmt::format("it holds shard {}", has.shard.empty() ? "1/1" : has.shard);
    }
    return {};
}

}  // namespace

void RunStore::Close::operator()(sqlite3* database) const { sqlite3_close(database); }

RunStore::RunStore(std::filesystem::path file, bool make) : file_(std::move(file)) {
    sqlite3* database = nullptr;
    const int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_FULLMUTEX | (make ? SQLITE_OPEN_CREATE : 0);
    const int code = sqlite3_open_v2(file_.c_str(), &database, flags, nullptr);
    database_.reset(database);
    if (code != SQLITE_OK) fail(code);
    sqlite3_busy_timeout(database, 1000);  // in ms; a program that was just killed can still hold the lock
    execute("PRAGMA locking_mode = EXCLUSIVE");
    execute("PRAGMA journal_mode = WAL");
    execute("PRAGMA synchronous = NORMAL");
    execute("BEGIN EXCLUSIVE");
    execute("COMMIT");
}

RunStore RunStore::open_or_make(const std::filesystem::path& file, const StoreIdentity& identity) {
    RunStore store(file, true);
    if (!store.has_tables()) {
        store.make_tables(identity);
        return store;
    }
    store.read_identity();
    const std::string difference = difference_of(store.identity_, identity);
    if (!difference.empty()) {
        throw InputError(fmt::format(
            "{}: {}. Such runs are never mixed: choose another --output, or remove this store to start again",
            file.string(), difference));
    }
    store.check_integrity();
    return store;
}

RunStore RunStore::open(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file)) throw InputError(fmt::format("{}: no such file", file.string()));
    RunStore store(file, false);
    if (!store.has_tables()) throw InputError(fmt::format("{}: the store holds no runs", file.string()));
    store.read_identity();
    store.check_integrity();
    return store;
}

bool RunStore::is_outdated(const std::filesystem::path& file, const StoreIdentity& identity) {
    RunStore store(file, false);
    if (!store.has_tables()) return false;
    const std::string format = store.meta_rows()["format"];
    if (format != kFormat && format.starts_with(kFormatOfAnyVersion)) return true;
    store.read_identity();
    return store.identity_.sweep != identity.sweep || store.identity_.program != identity.program;
}

void RunStore::fail(int code) const {
    if ((code & 0xff) == SQLITE_NOMEM) throw std::bad_alloc();
    throw InputError(fmt::format("{}: {}", file_.string(), reason(code, database_.get())));
}

void RunStore::fail_damaged(const std::string& damage) const {
    throw InputError(fmt::format("{}: the store is damaged: {}. Remove the file and repeat the sweep that wrote it",
                                 file_.string(), damage));
}

void RunStore::execute(const char* sql) const {
    const int code = sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr);
    if (code != SQLITE_OK) fail(code);
}

bool RunStore::has_tables() const {
    Statement statement(database_.get(), "SELECT count(*) FROM sqlite_master");
    const int code = statement.step();
    if (code != SQLITE_ROW) fail(code);
    return statement.number(0) > 0;
}

void RunStore::make_tables(const StoreIdentity& identity) {
    identity_ = identity;
    MetaRows rows{{"format", std::string(kFormat)},
                  {"name", identity.name},
                  {"sweep", identity.sweep},
                  {"program", identity.program},
                  {"points", fmt::format("{}", identity.points)},
                  {"shard", identity.shard},
                  {"provenance", identity.provenance}};
    rows[kChecksumRow] = checksum_of_meta(rows);
    // One transaction for both tables. If the program is killed, the store has either both tables or none. If it has
    // none, the next program that opens the store creates them.
    execute("BEGIN");
    execute("CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID");
    execute("CREATE TABLE runs(point INTEGER PRIMARY KEY, result TEXT NOT NULL, checksum TEXT NOT NULL)");
    for (const auto& [key, value] : rows) {
        Statement statement(database_.get(), "INSERT INTO meta VALUES(?, ?)");
        statement.bind(1, key);
        statement.bind(2, value);
        const int code = statement.step();
        if (code != SQLITE_DONE) fail(code);
    }
    execute("COMMIT");
}

std::map<std::string, std::string> RunStore::meta_rows() const {
    MetaRows rows;
    Statement statement(database_.get(), "SELECT key, value FROM meta");
    int code = statement.step();
    for (; code == SQLITE_ROW; code = statement.step()) rows[statement.text(0)] = statement.text(1);
    if (code != SQLITE_DONE && code != SQLITE_ERROR) fail(code);
    if (!rows["format"].starts_with(kFormatOfAnyVersion)) {
        throw InputError(
            fmt::format("{}: the file is not a store of stopline-sweep, or it is damaged", file_.string()));
    }
    return rows;
}

void RunStore::read_identity() {
    MetaRows rows = meta_rows();
    if (rows["format"] != kFormat) {
        throw InputError(
            fmt::format("{}: another version of the program wrote this store (its format is '{}', and this program "
                        "reads '{}'). Such runs are never mixed: choose another --output, or remove this store to "
                        "start again",
                        file_.string(), rows["format"], kFormat));
    }
    const ParsedWhole points = parse_whole(rows["points"]);
    if (rows[kChecksumRow] != checksum_of_meta(rows) || !points.problem.empty()) {
        fail_damaged("the description of the sweep does not match its checksum");
    }
    identity_ = {rows["name"],  rows["sweep"],     rows["program"], static_cast<std::size_t>(points.value),
                 rows["shard"], rows["provenance"]};
}

void RunStore::check_integrity() const {
    Statement statement(database_.get(), "PRAGMA integrity_check(1)");
    const int code = statement.step();
    if (code != SQLITE_ROW) fail(code);
    if (statement.text(0) != "ok") fail_damaged(statement.text(0));
    for_each_run([](std::size_t, const std::string&) {});
}

std::vector<bool> RunStore::done() const {
    std::vector<bool> done(identity_.points, false);
    for_each_run([&](std::size_t point, const std::string&) { done[point] = true; });
    return done;
}

void RunStore::put(std::size_t point, const std::string& result) {
    Statement statement(database_.get(), "INSERT INTO runs VALUES(?, ?, ?)");
    const std::string checksum = checksum_of_run(point, result);
    statement.bind(1, point);
    statement.bind(2, result);
    statement.bind(3, checksum);
    const int code = statement.step();
    if (code != SQLITE_DONE) fail(code);
}

void RunStore::put_in_one_transaction(const std::function<void()>& puts) {
    execute("BEGIN");
    puts();  // after an exception, closing the store rolls the transaction back
    execute("COMMIT");
}

void RunStore::for_each_run(const std::function<void(std::size_t, const std::string&)>& visit) const {
    Statement statement(database_.get(), "SELECT point, result, checksum FROM runs ORDER BY point");
    std::size_t next = 0;  // smallest number that the next run can have
    int code = statement.step();
    for (; code == SQLITE_ROW; code = statement.step()) {
        const std::size_t point = statement.number(0);
        if (!statement.is_number(0) || point < next || point >= identity_.points) {
            fail_damaged("it holds a run that the sweep does not have");
        }
        const std::string result = statement.text(1);
        if (!statement.is_text(1) || statement.text(2) != checksum_of_run(point, result)) {
            fail_damaged(fmt::format("run {} does not match its checksum", point));
        }
        visit(point, result);
        next = point + 1;
    }
    if (code == SQLITE_ERROR) fail_damaged(sqlite3_errmsg(database_.get()));
    if (code != SQLITE_DONE) fail(code);
}

}  // namespace stopline

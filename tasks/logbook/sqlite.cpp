// tasks/logbook/sqlite.cpp
// Thin calls into SQLite 3; see sqlite.h. Called by the logbook, outside the 1 kHz thread.
#include "tasks/logbook/sqlite.h"

#include <fmt/format.h>
#include <limits>
#include <sqlite3.h>

namespace tasks::sqlite {

Database::Database(std::string path) : path_(std::move(path)) {
    sqlite3* raw = nullptr;
    const int code =
        sqlite3_open_v2(path_.c_str(), &raw, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
    handle_.reset(raw); // a failed open still hands out a handle, which holds the message
    if (code != SQLITE_OK)
        fail("open");
    constexpr int kBusyWait_ms = 5000;
    sqlite3_busy_timeout(raw, kBusyWait_ms);
    sqlite3_extended_result_codes(raw, 1);
    run("PRAGMA foreign_keys = ON; PRAGMA secure_delete = ON; PRAGMA trusted_schema = OFF", "open");
}

void Database::Close::operator()(sqlite3* handle) const noexcept {
    sqlite3_close_v2(handle);
}

void Database::fail(std::string_view action) const {
    if (!handle_)
        refuse(action, "out of memory");
    refuse(action, fmt::format("{} (SQLite {})", sqlite3_errmsg(handle_.get()),
                               sqlite3_extended_errcode(handle_.get())));
}

void Database::refuse(std::string_view action, std::string_view why) const {
    throw LogbookError(fmt::format("{}: {}: {}", path_, action, why));
}

void Database::run(const char* sql, std::string_view action) {
    if (sqlite3_exec(handle_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK)
        fail(action);
}

std::int64_t Database::integer(const char* sql, std::string_view action) {
    Statement statement(*this, sql, action);
    return statement.step() ? statement.integer(0) : 0;
}

std::string Database::text(const char* sql, std::string_view action) {
    Statement statement(*this, sql, action);
    return statement.step() ? statement.text(0) : std::string();
}

std::int64_t Database::last_id() const {
    return sqlite3_last_insert_rowid(handle_.get());
}
int Database::changes() const {
    return sqlite3_changes(handle_.get());
}
bool Database::in_transaction() const {
    return sqlite3_get_autocommit(handle_.get()) == 0;
}

Statement::Statement(Database& database, std::string_view sql, std::string_view action)
    : database_(database), action_(action) {
    sqlite3_stmt* raw = nullptr;
    const int code = sqlite3_prepare_v2(database.handle(), sql.data(), static_cast<int>(sql.size()),
                                        &raw, nullptr);
    handle_.reset(raw);
    check(code);
}

void Statement::Finalize::operator()(sqlite3_stmt* handle) const noexcept {
    sqlite3_finalize(handle);
}

void Statement::check(int code) const {
    if (code != SQLITE_OK)
        database_.fail(action_);
}

Statement& Statement::arg_integer(std::int64_t value) {
    check(sqlite3_bind_int64(handle_.get(), next_++, value));
    return *this;
}

Statement& Statement::arg(double value) {
    check(sqlite3_bind_double(handle_.get(), next_++, value));
    return *this;
}

Statement& Statement::arg(std::string_view value) {
    // A null pointer would bind NULL instead of an empty text.
    check(sqlite3_bind_text64(handle_.get(), next_++, value.empty() ? "" : value.data(),
                              value.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
    return *this;
}

Statement& Statement::arg(std::span<const std::byte> value) {
    const void* data = value.empty() ? static_cast<const void*>("") : value.data();
    check(sqlite3_bind_blob64(handle_.get(), next_++, data, value.size_bytes(), SQLITE_TRANSIENT));
    return *this;
}

Statement& Statement::arg_null() {
    check(sqlite3_bind_null(handle_.get(), next_++));
    return *this;
}

bool Statement::step() {
    const int code = sqlite3_step(handle_.get());
    if (code != SQLITE_ROW && code != SQLITE_DONE)
        database_.fail(action_);
    return code == SQLITE_ROW;
}

void Statement::run() {
    while (step()) {
    }
    sqlite3_reset(handle_.get());
    sqlite3_clear_bindings(handle_.get());
    next_ = 1;
}

std::int64_t Statement::integer(int column) const {
    return sqlite3_column_int64(handle_.get(), column);
}

double Statement::real(int column) const {
    if (sqlite3_column_type(handle_.get(), column) == SQLITE_NULL)
        return std::numeric_limits<double>::quiet_NaN();
    return sqlite3_column_double(handle_.get(), column);
}

std::string Statement::text(int column) const {
    const auto* data = reinterpret_cast<const char*>(sqlite3_column_text(handle_.get(), column));
    if (data == nullptr)
        return {};
    return {data, static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column))};
}

std::vector<std::byte> Statement::blob(int column) const {
    const auto* data = static_cast<const std::byte*>(sqlite3_column_blob(handle_.get(), column));
    if (data == nullptr)
        return {};
    return {data, data + sqlite3_column_bytes(handle_.get(), column)};
}

Transaction::Transaction(Database& database, std::string_view action)
    : database_(database), action_(action) {
    database_.run("BEGIN IMMEDIATE", action_);
}

Transaction::~Transaction() {
    // After a full disk SQLite has often rolled back already. Nothing to report from here: what
    // failed has thrown.
    if (database_.in_transaction())
        sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() {
    database_.run("COMMIT", action_);
}

} // namespace tasks::sqlite

// tasks/logbook/sqlite.h
// Owners of SQLite handles: Database, Statement, Transaction. Used by the logbook and its tests;
// any thread, one at a time. Every failure throws LogbookError: file, action, SQLite's message.
#pragma once

#include "tasks/logbook/logbook.h"

#include <concepts>

struct sqlite3;
struct sqlite3_stmt;

namespace tasks::sqlite {

class Database {
  public:
    /// Opens or creates the file; its folder must exist. Foreign keys on, deleted content
    /// overwritten, functions in a foreign file's schema not trusted, waits 5 s for another writer.
    explicit Database(std::string path);

    /// One or more statements without arguments or results; `action` is for messages.
    void run(const char* sql, std::string_view action);
    /// The first column of the first row as an integer, or as text.
    std::int64_t integer(const char* sql, std::string_view action);
    std::string text(const char* sql, std::string_view action);

    std::int64_t last_id() const;
    int changes() const; // rows touched by the last statement
    bool in_transaction() const;
    const std::string& path() const { return path_; }
    sqlite3* handle() const { return handle_.get(); }
    /// Throws LogbookError with SQLite's last message, or with ours.
    [[noreturn]] void fail(std::string_view action) const;
    [[noreturn]] void refuse(std::string_view action, std::string_view why) const;

  private:
    struct Close {
        void operator()(sqlite3* handle) const noexcept;
    };
    std::string path_;
    std::unique_ptr<sqlite3, Close> handle_;
};

/// One prepared statement. Arguments are bound in the order of the arg() calls.
class Statement {
  public:
    Statement(Database& database, std::string_view sql, std::string_view action);

    template <std::integral T> Statement& arg(T value) {
        return arg_integer(static_cast<std::int64_t>(value));
    }
    Statement& arg(double value); // NaN is kept as NULL
    Statement& arg(std::string_view value);
    Statement& arg(std::span<const std::byte> value);
    Statement& arg_null();

    /// True while there is a row to read.
    bool step();
    /// Runs to the end and makes ready for the next set of arguments.
    void run();

    std::int64_t integer(int column) const;
    double real(int column) const; // NULL reads as NaN
    std::string text(int column) const;
    std::vector<std::byte> blob(int column) const;

  private:
    struct Finalize {
        void operator()(sqlite3_stmt* handle) const noexcept;
    };
    Statement& arg_integer(std::int64_t value);
    void check(int code) const;

    Database& database_;
    std::string action_;
    std::unique_ptr<sqlite3_stmt, Finalize> handle_;
    int next_ = 1;
};

/// Takes the write lock at once; rolls back unless committed.
class Transaction {
  public:
    Transaction(Database& database, std::string_view action);
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    void commit();

  private:
    Database& database_;
    std::string action_;
};

} // namespace tasks::sqlite

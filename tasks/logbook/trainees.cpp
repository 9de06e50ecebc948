// tasks/logbook/trainees.cpp
// The names file and what joins it to the logbook. Called by the commands and the window's trainee
// picker. The names file keeps no write-ahead log, which would hold on to deleted names: with a
// rollback journal and secure_delete a deleted name is in no file of ours.
#include "tasks/logbook/logbook_impl.h"
#include "tasks/logbook/schema.h"
#include "tasks/logbook/uuid.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace tasks {

using sqlite::Statement;
using sqlite::Transaction;

namespace {

std::string names_path(const std::string& path) {
    const std::filesystem::path main(path);
    std::filesystem::path name = main.stem();
    name += ".names";
    name += main.extension();
    return (main.parent_path() / name).string();
}

int count_attempts(sqlite::Database& main, std::string_view id) {
    Statement count(main, "SELECT count(*) FROM attempt WHERE trainee = ?", "count attempts");
    count.arg(id).step();
    return static_cast<int>(count.integer(0));
}

// Empty: nobody has this name.
std::string id_of_name(sqlite::Database& names, std::string_view name, std::string_view action) {
    Statement select(names, "SELECT id FROM trainee WHERE name = ?", action);
    return select.arg(name).step() ? select.text(0) : std::string();
}

bool has_control_character(std::string_view text) {
    return std::any_of(text.begin(), text.end(), [](char c) {
        return static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) == 0x7f;
    });
}

} // namespace

sqlite::Database& Logbook::Impl::names() {
    if (!names_) {
        sqlite::Database file(names_path(main.path()));
        migrate(file, kNamesSchema);
        file.run("PRAGMA journal_mode = DELETE; PRAGMA synchronous = FULL", "open");
        names_ = std::move(file);
    }
    return *names_;
}

std::string Logbook::add_trainee(std::string_view name) {
    constexpr std::string_view kAction = "add trainee";
    sqlite::Database& names = impl_->names();
    if (name.empty() || has_control_character(name))
        names.refuse(kAction, "a name is one line of text and not empty");
    if (is_uuid(name))
        names.refuse(kAction, "this name reads as an id");
    Transaction transaction(names, kAction);
    if (const std::string id = id_of_name(names, name, kAction); !id.empty())
        names.refuse(kAction,
                     fmt::format("this name is there already, with id {}; add what tells the two "
                                 "people apart",
                                 id));
    std::string id = random_uuid();
    Statement insert(names, "INSERT INTO trainee (id, name) VALUES (?, ?)", kAction);
    insert.arg(id).arg(name).run();
    transaction.commit();
    return id;
}

std::vector<Logbook::Trainee> Logbook::trainees() {
    std::vector<Trainee> list;
    Statement select(impl_->names(), "SELECT id, name FROM trainee ORDER BY name, id",
                     "list trainees");
    while (select.step())
        list.push_back(
            {select.text(0), select.text(1), count_attempts(impl_->main, select.text(0))});
    return list;
}

bool Logbook::delete_trainee(std::string_view id_or_name, bool with_attempts) {
    constexpr std::string_view kAction = "delete trainee";
    sqlite::Database& names = impl_->names();
    const std::string id =
        is_uuid(id_or_name) ? std::string(id_or_name) : id_of_name(names, id_or_name, kAction);
    if (id.empty())
        return false;
    bool found = false;
    // Attempts first: if this is cut off between the two files, the name is still there to try
    // again by.
    if (with_attempts) {
        Statement(impl_->main, "DELETE FROM attempt WHERE trainee = ?", kAction).arg(id).run();
        found = impl_->main.changes() > 0;
        impl_->main.run("PRAGMA wal_checkpoint(TRUNCATE)", kAction); // old pages out of the log
    }
    Statement(names, "DELETE FROM trainee WHERE id = ?", kAction).arg(id).run();
    return found || names.changes() > 0;
}

} // namespace tasks

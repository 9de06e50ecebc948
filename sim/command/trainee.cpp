// sim/command/trainee.cpp
// trocar trainee add|list|delete and trocar note: the instructor's side of the logbook.
#include "sim/command/commands.h"
#include "sim/io/files.h"
#include "tasks/logbook/summary.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace sim {
namespace {

struct TraineeArguments {
    std::string db, name;
    bool with_attempts = false, json = false;
};

/// The user's folder is only made when it is needed: other commands must work without a home.
std::string db_of(const TraineeArguments& a) {
    return a.db.empty() ? (user_data_dir() / "station.db").string() : a.db;
}

void list(const TraineeArguments& a) {
    tasks::Logbook logbook(db_of(a));
    const auto trainees = tasks::summarise(logbook);
    fmt::print("{}{}", a.json ? tasks::summary_json(trainees) : tasks::summary_text(trainees),
               a.json ? "\n" : "");
}

void remove(const TraineeArguments& a) {
    tasks::Logbook logbook(db_of(a));
    if (!logbook.delete_trainee(a.name, a.with_attempts)) {
        throw std::invalid_argument(
            fmt::format("{}: no trainee with the name or id \"{}\"", db_of(a), a.name));
    }
    fmt::print("deleted {}{}\n", a.name,
               a.with_attempts ? " and all attempts" : "; attempts stay under the pseudonym");
}

} // namespace

void add_trainee(CLI::App& app, int&) {
    auto a = std::make_shared<TraineeArguments>();
    CLI::App* c = app.add_subcommand("trainee", "Who trains at this station");
    c->require_subcommand(1);
    CLI::App* add = c->add_subcommand("add", "Add a trainee; prints the pseudonymous id");
    add->add_option("name", a->name, "Name, kept in a file of its own")->required();
    CLI::App* show =
        c->add_subcommand("list", "Who has done what: attempts with their key metrics");
    show->add_flag("--json", a->json, "One JSON object instead of a table");
    CLI::App* gone = c->add_subcommand("delete", "Forget a trainee's name for ever");
    gone->add_option("id", a->name, "Id or name")->required();
    gone->add_flag("--with-attempts", a->with_attempts, "Delete the attempts too");
    for (CLI::App* sub : {add, show, gone}) {
        sub->add_option("--log", a->db, "Logbook; default: station.db in the user's data folder");
    }
    add->callback([a] {
        tasks::Logbook logbook(db_of(*a));
        fmt::print("{}\n", logbook.add_trainee(a->name));
    });
    show->callback([a] { list(*a); });
    gone->callback([a] { remove(*a); });
}

void add_note(CLI::App& app, int&) {
    struct NoteArguments {
        std::string db, text;
        std::int64_t attempt = 0, tick = 0;
    };
    auto a = std::make_shared<NoteArguments>();
    CLI::App* c = app.add_subcommand("note", "Write an instructor's note to a moment");
    c->add_option("db", a->db, "Logbook")->required()->check(CLI::ExistingFile);
    c->add_option("attempt", a->attempt, "Number of the attempt")->required();
    c->add_option("tick", a->tick, "Millisecond of the attempt")->required();
    c->add_option("text", a->text, "The note")->required();
    c->callback([a] {
        tasks::Logbook logbook(a->db);
        if (!logbook.attempt(a->attempt)) {
            throw std::invalid_argument(fmt::format("{}: has no attempt {}", a->db, a->attempt));
        }
        fmt::print("note {}\n", logbook.add_note(a->attempt, a->tick, a->text));
    });
}

} // namespace sim

// tasks/logbook/logbook_impl.h
// What a Logbook holds: the station's database and, from the first use on, the names file beside
// it. Only for logbook.cpp and trainees.cpp.
#pragma once

#include "tasks/logbook/sqlite.h"

namespace tasks {

struct Logbook::Impl {
    explicit Impl(const std::string& path);

    sqlite::Database main;
    /// Opens "station.names.db" beside "station.db". Late, so that a logbook that was handed on
    /// without names is read without making an empty file.
    sqlite::Database& names();

  private:
    std::optional<sqlite::Database> names_;
};

} // namespace tasks

// assets/bake/import/staging.h
// A folder that appears whole or not at all: made beside its final place under another name, then
// renamed. Called by import_main.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace bake {

/// File or folder that cannot be used; the message names it and the reason.
struct PathError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// For messages: control characters replaced.
std::string shown_path(const std::filesystem::path& path);

class Staging {
  public:
    /// `out` may be missing, empty, or an earlier import (report.json and nothing that import does
    /// not write); throws PathError for anything else.
    explicit Staging(const std::filesystem::path& out);
    ~Staging(); // removes what was not put in place
    Staging(const Staging&) = delete;
    Staging& operator=(const Staging&) = delete;

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
    /// Replaces `out` in one step. Throws PathError.
    void put_in_place();

  private:
    std::filesystem::path out_, folder_;
};

void write_whole(const std::filesystem::path& file, std::string_view bytes);

} // namespace bake

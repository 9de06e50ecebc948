// tasks/exercise/toml_reader.h
// Reads tables of TOML bytes with messages a person can act on: file, line, key, value and what
// would be accepted. Called by the parsers of tasks/ (exercises, scripts); toml11 stays behind it.
// Not real-time safe. Everything throws BadInput and nothing else.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tasks {

struct Range { // inclusive
    double min = 0.0, max = 0.0;
};

/// A key and its value as they stand in a file: what a person has to look at.
struct Mention {
    std::string file;
    std::size_t line = 0;
    std::string key;   // empty: the line itself is meant
    std::string value; // as written, cut to one short line; empty: the key is missing
};

/// "file:line: key = value: `accepted`", or "key is missing" without a value.
std::string message_of(const Mention& at, const std::string& accepted);

struct BadInput : std::invalid_argument {
    BadInput(Mention where, std::string what_is_accepted)
        : std::invalid_argument(message_of(where, what_is_accepted)), at(std::move(where)),
          accepted(std::move(what_is_accepted)) {}
    Mention at;
    std::string accepted;
};

/// One table of a file. Copies are cheap views of the same parsed file.
class TomlTable {
  public:
    /// The whole file. `text` may be any bytes; other than UTF-8 they are refused.
    static TomlTable parse(std::string_view text, std::string_view file);

    /// Any other key in this table is an error; the message lists these.
    void accept_only(std::initializer_list<std::string_view> keys) const;
    bool has(std::string_view key) const;
    std::string where() const; // "file:line" of the table

    // The value of `key`; without it the fallback, or an error if there is none. Numbers may be
    // written as integers. Out of range and not finite are errors.
    double number(std::string_view key, Range range, std::optional<double> fallback = {}) const;
    std::string text(std::string_view key, std::optional<std::string> fallback = {}) const;
    /// One of `choices`; returns its index.
    int choice(std::string_view key, const std::vector<std::string>& choices) const;
    /// [[a, b], ...]: at least one pair and at most `most`, each number inside its range. `what`
    /// says what they are, for messages.
    std::vector<std::array<double, 2>> pairs(std::string_view key, std::string_view what,
                                             std::size_t most, Range first, Range second) const;
    /// [x, y, z] in millimetres, returned in metres; each component inside the range (mm).
    glm::dvec3 place_mm(std::string_view key, Range range_mm) const;
    /// The table written as [key]; an error without it.
    TomlTable table(std::string_view key) const;
    /// [[key]] tables in the order of the file; none if the key is absent.
    std::vector<TomlTable> tables(std::string_view key) const;

    /// Where `key` stands, or the table if the key is missing.
    Mention mention(std::string_view key) const;
    /// Throws BadInput with mention(key).
    [[noreturn]] void refuse(std::string_view key, const std::string& accepted) const;

  private:
    struct Node;
    explicit TomlTable(std::shared_ptr<const Node> node) : node_(std::move(node)) {}
    std::shared_ptr<const Node> node_;
};

} // namespace tasks

#include "tasks/exercise/toml_reader.h"

#include <doctest/doctest.h>
#include <stdexcept>

using tasks::TomlTable;

namespace {

std::string message(const std::string& text, void (*read)(const TomlTable&)) {
    try {
        read(TomlTable::parse(text, "f"));
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "accepted";
}

} // namespace

TEST_CASE("a table is found by its name and its mistakes are named by their own line") {
    const TomlTable root = TomlTable::parse("a = 1\n[view]\nwide = 3\n", "f");
    CHECK(root.table("view").number("wide", {0.0, 5.0}) == 3.0);
    CHECK(message("a = 1\n[view]\nwide = 3\n", [](const TomlTable& t) {
              t.table("view").number("wide", {0.0, 1.0});
          }) == "f:3: wide = 3: a number from 0 to 1");
    CHECK(message("a = 1\n", [](const TomlTable& t) { t.table("view"); }) ==
          "f:1: view is missing: a table written as [view]");
    CHECK(message("\nview = 1\n", [](const TomlTable& t) { t.table("view"); }) ==
          "f:2: view = 1: a table written as [view]");
    CHECK(message("\nview = 1\n", [](const TomlTable& t) { t.tables("view"); }) ==
          "f:2: view = 1: tables written as [[view]]");
}

TEST_CASE("of several unknown keys the first in the file is reported") {
    CHECK(message("a = 1\nz = 2\nb = 3\n", [](const TomlTable& t) { t.accept_only({"a"}); }) ==
          "f:2: z = 2: unknown key; accepted here: a");
    CHECK(message("a = 1\n", [](const TomlTable& t) { t.accept_only({"a"}); }) == "accepted");
}

TEST_CASE("a fallback stands for an absent key only") {
    const TomlTable root = TomlTable::parse("a = 7\ns = \"x\"\n", "f");
    CHECK(root.number("b", {0.0, 1.0}, 0.5) == 0.5);
    CHECK(root.number("a", {0.0, 10.0}, 0.5) == 7.0);
    CHECK_THROWS_AS(root.number("a", {0.0, 1.0}, 0.5), std::invalid_argument);
    CHECK(root.text("s", "y") == "x");
    CHECK(root.text("t", "y") == "y");
    CHECK_THROWS_AS(root.text("a", "y"), std::invalid_argument);
}

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

TEST_CASE("pairs of numbers are read, and what is none is named with what would be") {
    const auto root = TomlTable::parse("p = [[0.3, 0.5], [0.2, 8]]\n", "f");
    const auto pairs = root.pairs("p", "[share, time_s]", 4, {0.0, 1.0}, {0.0, 10.0});
    CHECK(pairs == std::vector<std::array<double, 2>>{{0.3, 0.5}, {0.2, 8.0}});
    const std::string accepted =
        "[[share, time_s], ...], 1 to 2 pairs, the first number 0 to 1, the "
        "second 0 to 10";
    for (const char* bad : {"[]", "3", "[1, 2]", "[[1, 2, 3]]", "[[0.5, \"x\"]]", "[[2, 2]]",
                            "[[0.1, nan]]", "[[0, 1], [0, 1], [0, 1]]"}) {
        CAPTURE(bad);
        const std::string said =
            message("\np = " + std::string(bad) + "\n", [](const TomlTable& t) {
                t.pairs("p", "[share, time_s]", 2, {0.0, 1.0}, {0.0, 10.0});
            });
        CHECK(said.starts_with("f:2: p = "));
        CHECK(said.ends_with(accepted));
    }
}

TEST_CASE("bytes that are not UTF-8 are refused with their line, wherever they stand") {
    const auto read = [](const TomlTable& t) { t.text("a"); };
    // the edges of table 3-7 of the Unicode standard: lone and cut sequences, overlong forms,
    // surrogates, above U+10FFFF
    for (const char* bad : {"\xff", "\x80", "\xc3", "\xc1\xbf", "\xe0\x9f\xbf", "\xe2\x82",
                            "\xed\xa0\x80", "\xf0\x8f\xbf\xbf", "\xf4\x90\x80\x80", "\xf5\x80"}) {
        const std::string said = message("\na = 'x" + std::string(bad) + "'\n", read);
        CAPTURE(said);
        CHECK(said.starts_with("f:2: byte 0x"));
        CHECK(said.ends_with(" is not UTF-8: text in UTF-8 is accepted"));
        CHECK(message("a = \"" + std::string(bad) + "\"\n", read).starts_with("f:1: byte 0x"));
        CHECK(message("a = 'x' # " + std::string(bad), read).starts_with("f:1: byte 0x"));
        CHECK(message(std::string(bad) + " = 1\n", read).starts_with("f:1: byte 0x"));
    }
    for (const char* good : {"\x7e", "\xc2\x80", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf",
                             "\xee\x80\x80", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"}) {
        CHECK(message("a = 'x" + std::string(good) + "'\n", read) == "accepted");
    }
}

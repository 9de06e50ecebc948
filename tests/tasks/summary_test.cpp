// tests/tasks/summary_test.cpp
// The list of trainees and their attempts: grouping, order, and what is said about gaps.
#include "tasks/logbook/summary.h"

#include "tests/tasks/logbook_samples.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

namespace {

struct Station {
    samples::Folder folder;
    tasks::Logbook book{folder.file("station.db")};
    std::int64_t session = book.add_session(samples::session());
    std::string ada = book.add_trainee("Ada"), bea = book.add_trainee("Bea"),
                gone = book.add_trainee("Cleo");

    std::int64_t run(const std::string& trainee, std::span<const tasks::Metric> metrics) {
        auto row = samples::attempt(session);
        row.trainee = trainee;
        const auto id = book.begin_attempt(row);
        row.completed = row.valid = true;
        book.end_attempt(id, row, metrics);
        return id;
    }

    Station() {
        auto felt = samples::metric("force_peak", 1.234, "N");
        felt.felt = false;
        auto renewed = samples::metric("time", 71.25, "s");
        renewed.version = 2;
        const std::vector<tasks::Metric> metrics{renewed,
                                                 samples::metric("time", 60.0, "s"),
                                                 samples::metric("path_length", 0.8125, "m"),
                                                 samples::metric("path_length.left", 0.5, "m"),
                                                 samples::metric("errors", 3, "1"),
                                                 felt};
        run("", {});
        run(bea, metrics);
        run(gone, {});
        auto row = samples::attempt(session);
        row.trainee = bea;
        book.begin_attempt(row); // and the power fails
        book.delete_trainee(gone, false);
    }
};

std::string line_with(const std::string& text, const std::string& part) {
    const auto at = text.find(part);
    REQUIRE(at != std::string::npos);
    const auto begin = text.rfind('\n', at) + 1;
    return text.substr(begin, text.find('\n', at) - begin);
}

} // namespace

TEST_CASE("the summary lists trainees by name, then pseudonyms, then attempts of nobody") {
    Station station;
    const auto list = tasks::summarise(station.book);
    REQUIRE(list.size() == 4);
    CHECK(list[0].name == "Ada");
    CHECK(list[0].attempts.empty());
    CHECK(list[1].name == "Bea");
    REQUIRE(list[1].attempts.size() == 2);
    CHECK(list[1].attempts[0].input_class == "scripted");
    CHECK(list[2].id == station.gone);
    CHECK(list[2].name.empty());
    CHECK(list[3].id.empty());
    CHECK(list[3].attempts.size() == 1);
}

TEST_CASE("the summary takes the newest version of a metric and leaves out what was not measured") {
    Station station;
    const auto list = tasks::summarise(station.book);
    const auto& done = list[1].attempts[0];
    CHECK(done.time->value == 71.25);
    CHECK(done.path_length->value == 0.8125);
    CHECK(done.errors->value == 3);
    const auto& broken = list[1].attempts[1];
    CHECK_FALSE(broken.ended);
    CHECK_FALSE(broken.time);
}

TEST_CASE("the table says when an attempt was broken off and when a force was not felt") {
    Station station;
    const std::string text = tasks::summary_text(tasks::summarise(station.book));
    MESSAGE("\n" << text);
    CHECK(line_with(text, "Ada") == "Ada  " + station.ada + ": 0 attempts");
    CHECK(line_with(text, "Bea") == "Bea  " + station.bea + ": 2 attempts");
    const std::string done = line_with(text, "71.2");
    CHECK(done.find("complete") != std::string::npos);
    CHECK(done.find("0.812") != std::string::npos);
    CHECK(done.find("not felt") != std::string::npos);
    CHECK(done.find("1.23") == std::string::npos);
    CHECK(line_with(text, "broken off").find(" no ") != std::string::npos);
    CHECK(line_with(text, station.gone) == "(name deleted)  " + station.gone + ": 1 attempt");
    CHECK(text.find("(no trainee): 1 attempt\n") != std::string::npos);
    CHECK(tasks::summary_text({}).empty());
}

TEST_CASE("every line of a table is as wide as its heading") {
    Station station;
    const std::string text = tasks::summary_text(tasks::summarise(station.book));
    const std::size_t width = line_with(text, "peak force").size();
    CHECK(line_with(text, "71.2").size() == width);
    CHECK(line_with(text, "broken off").size() == width);
}

TEST_CASE("the JSON of the summary holds the same, with null for a forgotten name") {
    Station station;
    const auto json =
        nlohmann::json::parse(tasks::summary_json(tasks::summarise(station.book)))["trainees"];
    REQUIRE(json.size() == 4);
    CHECK(json[1]["name"] == "Bea");
    CHECK(json[1]["attempts"][0]["metrics"]["time"]["value"] == 71.25);
    CHECK(json[1]["attempts"][0]["metrics"]["time"]["version"] == 2);
    CHECK(json[1]["attempts"][0]["metrics"]["force_peak"]["felt"] == false);
    CHECK(json[1]["attempts"][0]["started_utc"] == "2026-01-02T03:04:05Z");
    CHECK(json[1]["attempts"][1]["ended"] == false);
    CHECK(json[1]["attempts"][1]["metrics"].empty());
    CHECK(json[2]["name"].is_null());
    CHECK(json[2]["id"] == station.gone);
    CHECK(json[3]["id"] == "");
}

// tests/sim/failures_study_test.cpp
// The published failures show where theory says, and the methods that are known to hold do.
#include "sim/study/failures_study.h"

#include "sim/io/files.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <filesystem>
#include <set>
#include <unistd.h>

namespace {

const std::vector<sim::FailureRow>& rows() {
    static const std::vector<sim::FailureRow> all = sim::run_failures_study({});
    return all;
}

} // namespace

TEST_CASE("failures: every method does in every scene what is known of it") {
    CHECK(rows().size() > 100);
    for (const sim::FailureRow& r : rows()) {
        CAPTURE(r.scene);
        CAPTURE(r.method);
        CAPTURE(r.quantity);
        CAPTURE(r.measured);
        CAPTURE(r.bound);
        CHECK(r.passed);
        CHECK(r.passed == (r.margin >= 0.0));
    }
}

TEST_CASE("failures: every scene makes some method fail, and holds every method to account") {
    std::set<std::string> scenes, failing;
    for (const sim::FailureRow& r : rows()) {
        scenes.insert(r.scene);
        if (r.wrong_expected)
            failing.insert(r.scene);
    }
    CHECK(failing == scenes);
    for (const sim::ContactMethod& method : sim::kContactMethods)
        for (const char* scene : {"F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8", "F18"})
            CHECK(std::any_of(rows().begin(), rows().end(), [&](const sim::FailureRow& r) {
                return r.scene == scene && r.method == method.name;
            }));
}

TEST_CASE("failures: another seed shows the same") {
    for (const sim::FailureRow& r : sim::run_failures_study({2, {"F3"}})) {
        CAPTURE(r.method);
        CAPTURE(r.quantity);
        CAPTURE(r.measured);
        CHECK(r.passed);
    }
}

TEST_CASE("failures: the same seed gives the same rows, a scene can be asked for alone") {
    const auto one = sim::run_failures_study({7, {"F3"}}),
               two = sim::run_failures_study({7, {"F3"}});
    REQUIRE(one.size() == two.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        CHECK(one[i].scene == "F3");
        CHECK(one[i].measured == two[i].measured);
    }
    CHECK_THROWS_WITH_AS(sim::run_failures_study({1, {"F99"}}),
                         doctest::Contains("failure scene \"F99\""), std::invalid_argument);
}

TEST_CASE("failures: a file for machines and a page for people") {
    const auto folder =
        std::filesystem::temp_directory_path() / ("trocar_failures_" + std::to_string(getpid()));
    sim::write_failures_study({}, rows(), folder);
    const std::string csv = sim::read_text(folder / "failures.csv");
    CHECK(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')) == rows().size() + 1);
    const std::string page = sim::read_text(folder / "failures.md");
    CHECK(page.find("fails as known") != std::string::npos);
    CHECK(page.find("UNEXPECTED") == std::string::npos);
    std::filesystem::remove_all(folder);
}

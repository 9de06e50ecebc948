// tests/sim/failures_study_test.cpp
// The published failures show where theory says, and the methods that are known to hold do.
#include "sim/study/failures_study.h"

#include "sim/io/files.h"
#include "sim/study/failures_chart.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <filesystem>
#include <limits>
#include <regex>
#include <set>
#include <unistd.h>

namespace {

const std::vector<sim::FailureRow>& rows() {
    static const std::vector<sim::FailureRow> all = sim::run_failures_study({});
    return all;
}

/// A check of its own making, in the scene and method given.
sim::FailureRow row(const char* method, double measured, double bound, bool wrong_expected,
                    const char* scene = "F1") {
    const bool right = measured <= bound;
    return {.scene = scene,
            .method = method,
            .quantity = "made up",
            .measured = measured,
            .bound = bound,
            .wrong_expected = wrong_expected,
            .passed = right != wrong_expected};
}

struct Box {
    double x, y, width, height;
    bool within(const Box& outer) const {
        return x >= outer.x && y >= outer.y && x + width <= outer.x + outer.width &&
               y + height <= outer.y + outer.height;
    }
    bool meets(const Box& b) const {
        return x < b.x + b.width && b.x < x + width && y < b.y + b.height && b.y < y + height;
    }
};

/// What a picture consists of; letters of DejaVu Sans are 0.6 of their height wide on average.
struct Picture {
    Box sheet{0.0, 0.0, 0.0, 0.0};
    std::vector<Box> cell, words;

    explicit Picture(const std::string& svg) {
        std::smatch size;
        std::regex_search(svg, size, std::regex("viewBox=\"0 0 ([0-9.]+) ([0-9.]+)\""));
        sheet.width = std::stod(size[1]);
        sheet.height = std::stod(size[2]);
        const std::regex rect("<rect class=\"(cell|legend)\" x=\"([0-9.]+)\" y=\"([0-9.]+)\" "
                              "width=\"([0-9.]+)\" height=\"([0-9.]+)\"");
        for (std::sregex_iterator i(svg.begin(), svg.end(), rect), end; i != end; ++i)
            cell.push_back(
                {std::stod((*i)[2]), std::stod((*i)[3]), std::stod((*i)[4]), std::stod((*i)[5])});
        const std::regex text("<text x=\"([0-9.]+)\" y=\"([0-9.]+)\" text-anchor=\"start\" "
                              "font-size=\"([0-9.]+)\"[^>]*>([^<]*)</text>");
        for (std::sregex_iterator i(svg.begin(), svg.end(), text), end; i != end; ++i) {
            const double high = std::stod((*i)[3]);
            const std::string read = std::regex_replace((*i)[4].str(), std::regex("&[a-z]+;"), "?");
            words.push_back({std::stod((*i)[1]), std::stod((*i)[2]) - 0.8 * high,
                             0.6 * high * static_cast<double>(read.size()), high});
        }
    }
};

std::size_t count(const std::string& text, const std::string& what) {
    std::size_t n = 0;
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
        ++n;
    return n;
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

TEST_CASE("failures: ours are held to account in every scene of tissue, and fail in none") {
    for (const char* scene : {"F9", "F10", "F11", "F12", "F13", "F14"})
        for (const char* ours : {"corotated", "quadratic"}) {
            const bool linear = std::string(ours) == "corotated";
            const auto row = std::find_if(rows().begin(), rows().end(), [&](const auto& r) {
                return r.scene == scene && r.method == ours;
            });
            CAPTURE(scene);
            CAPTURE(ours);
            // of linear tets that lock no one expects otherwise
            CHECK((row != rows().end()) == !(linear && scene == std::string("F10")));
        }
    for (const sim::FailureRow& r : rows())
        CHECK_FALSE(((r.method == "corotated" || r.method == "quadratic") && r.wrong_expected));
}

TEST_CASE("failures: the baselines of tissue fail where the literature has them fail") {
    const std::set<std::pair<std::string, std::string>> known{
        {"F9", "TLED"},         {"F9", "mass-spring"},  {"F9", "one Newton a step"},
        {"F10", "linear tets"}, {"F10", "TLED"},        {"F10", "mass-spring"},
        {"F11", "TLED"},        {"F11", "mass-spring"}, {"F12", "warped, no dR"},
        {"F13", "XPBD"},        {"F13", "PBD"},         {"F13", "projective"},
        {"F14", "linear"}};
    for (const auto& [scene, method] : known) {
        CAPTURE(scene);
        CAPTURE(method);
        CHECK(std::any_of(rows().begin(), rows().end(), [&](const sim::FailureRow& r) {
            return r.scene == scene && r.method == method && r.wrong_expected && r.passed;
        }));
    }
}

TEST_CASE("failures: another seed shows the same") {
    for (const sim::FailureRow& r : sim::run_failures_study({2, {"F3", "F11", "F12", "F14"}})) {
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

TEST_CASE("failures: a cell tells the gravest that its checks do, and of those the worst") {
    using enum sim::FailureVerdict;
    const auto cells = sim::failure_cells({
        row("right", 0.5, 2.0, false),
        row("right", 0.0, 0.0, false),
        row("wrong", 0.5, 2.0, false),
        row("wrong", 6.0, 2.0, true),
        row("wrong", 30.0, 2.0, true),
        row("worse", 30.0, 2.0, true),
        row("worse", 3.0, 2.0, false),
        row("cured", 1.0, 2.0, true),
        row("counts", 3.0, 0.0, true),
        row("counts", 7.0, 0.0, true),
        row("broken", std::numeric_limits<double>::quiet_NaN(), 2.0, false),
        row("right", 30.0, 2.0, true, "F2"),
    });
    struct Wanted {
        const char* method;
        sim::FailureVerdict verdict;
        int counted, checks;
        const char* worst;
    };
    const std::vector<Wanted> wanted{{"right", holds, 2, 2, "worst 0.25 x gate"},
                                     {"wrong", fails_as_known, 2, 3, "worst 15 x gate"},
                                     {"worse", unexpected, 1, 2, "worst 1.5 x gate"},
                                     {"cured", unexpected, 1, 1, "worst 0.5 x gate"},
                                     {"counts", fails_as_known, 2, 2, "worst 7, gate 0"},
                                     {"broken", unexpected, 1, 1, "not finite"},
                                     {"right", fails_as_known, 1, 1, "worst 15 x gate"}};
    REQUIRE(cells.size() == wanted.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        CHECK(cells[i].method == wanted[i].method);
        CHECK(cells[i].verdict == wanted[i].verdict);
        CHECK(cells[i].counted == wanted[i].counted);
        CHECK(cells[i].checks == wanted[i].checks);
        CHECK(cells[i].worst == wanted[i].worst);
    }
}

TEST_CASE("failures: the picture has every method in every scene, inside and beside each other") {
    std::vector<sim::FailureRow> all = rows();
    // names longer than any room, and more methods than there are columns
    for (int i = 0; i < 12; ++i)
        all.push_back(row(std::string(60 + i, 'x').c_str(), 3.0, 2.0, false));
    std::vector<sim::FailureScene> scenes;
    const std::string about(200, 'y'), caption(300, 'z');
    for (const sim::FailureRow& r : all)
        if (std::none_of(scenes.begin(), scenes.end(),
                         [&](const sim::FailureScene& s) { return s.name == r.scene; }))
            scenes.push_back({r.scene, about});
    const std::string svg = sim::failures_svg(scenes, all, std::vector{caption});
    const Picture picture(svg);
    CHECK(count(svg, "class=\"cell\"") == sim::failure_cells(all).size());
    CHECK(picture.cell.size() == sim::failure_cells(all).size() + 3);
    CHECK(picture.words.size() == count(svg, "<text "));
    for (std::size_t i = 0; i < picture.cell.size(); ++i) {
        CHECK(picture.cell[i].within(picture.sheet));
        for (std::size_t j = 0; j < i; ++j)
            CHECK_FALSE(picture.cell[i].meets(picture.cell[j]));
    }
    for (std::size_t i = 0; i < picture.words.size(); ++i) {
        CHECK(picture.words[i].within(picture.sheet));
        for (const Box& cell : picture.cell)
            CHECK((picture.words[i].within(cell) || !picture.words[i].meets(cell)));
        for (std::size_t j = 0; j < i; ++j)
            CHECK_FALSE(picture.words[i].meets(picture.words[j]));
    }
}

TEST_CASE("failures: signs and words tell failures apart, not colours alone") {
    const std::vector<sim::FailureScene> scenes{{"F1", "made up"}};
    std::set<std::string> signs;
    for (const sim::FailureRow& r : {row("ours", 1.0, 2.0, false), row("ours", 3.0, 2.0, true),
                                     row("ours", 3.0, 2.0, false)}) {
        const std::string svg = sim::failures_svg(scenes, {r}, {});
        const std::string word = !r.passed          ? "UNEXPECTED"
                                 : r.wrong_expected ? "fails as known"
                                                    : "holds";
        CHECK(count(svg, ">" + word + "</text>") == 1);
        const auto at = svg.find("<path d=\"", svg.find("class=\"cell\""));
        signs.insert(svg.substr(at, svg.find(" transform", at) - at));
    }
    CHECK(signs.size() == 3);
}

TEST_CASE("failures: a file for machines, a page for people and a picture") {
    const auto folder =
        std::filesystem::temp_directory_path() / ("trocar_failures_" + std::to_string(getpid()));
    sim::write_failures_study({}, rows(), folder);
    const std::string csv = sim::read_text(folder / "failures.csv");
    CHECK(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')) == rows().size() + 1);
    const std::string page = sim::read_text(folder / "failures.md");
    CHECK(page.find("fails as known") != std::string::npos);
    CHECK(page.find("UNEXPECTED") == std::string::npos);
    CHECK(page.find("](failures.svg)") != std::string::npos);
    const std::string svg = sim::read_text(folder / "failures.svg");
    CHECK(count(svg, ">UNEXPECTED</text>") == 0);
    for (const std::string& text : {page, svg})
        for (const char* told : {"Seed 1.", "Machine: ", "Reference: "})
            CHECK(text.find(told) != std::string::npos);
    std::filesystem::remove_all(folder);
}

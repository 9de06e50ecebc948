// tests/sim/scaling_study_test.cpp
// The scaling study compares within a round, names what is missing, and says so when two did not do
// the same work.
#include "sim/study/peer_program.h"
#include "sim/study/scaling_study.h"
#include "sim/study/svg_chart.h"

#include <algorithm>
#include <array>
#include <doctest/doctest.h>
#include <stdexcept>

namespace {

sim::ScalingRow row(const std::string& size, const std::string& name, int round, double mean_ns,
                    double distance_sum_m = 1.0) {
    sim::ScalingRow r;
    r.size = size;
    r.name = name;
    r.round = round;
    r.triangles = 1000;
    r.times.mean_ns = mean_ns;
    r.distance_sum_m = distance_sum_m;
    return r;
}

std::string text_of(const std::vector<std::pair<std::string, std::string>>& files,
                    const std::string& name) {
    for (const auto& [file, text] : files)
        if (file == name)
            return text;
    return {};
}

} // namespace

TEST_CASE("scaling: a ratio is taken within a round, so a slow minute changes nothing") {
    sim::ScalingStudy study;
    const std::array ours_ns{50.0, 60.0, 700.0}, embree_ns{100.0, 100.0, 1000.0};
    for (int round = 0; round < 3; ++round) { // the machine was busy in the last
        study.row.push_back(row("1k", "ours", round, ours_ns[round]));
        study.row.push_back(row("1k", "embree", round, embree_ns[round]));
    }
    study.row.push_back(row("1k", "ours", 3, 7000.0)); // a round without the peer
    CHECK(sim::median_ratios(study, "1k", "ours", "embree").mean_ns == 0.6);
    CHECK(sim::median_times(study, "1k", "ours").mean_ns == 380.0);
    CHECK(sim::median_ratios(study, "1k", "ours", "absent").mean_ns == 0.0);
    CHECK(sim::median_times(study, "2k", "ours").mean_ns == 0.0);
    CHECK(study.names() == std::vector<std::string>{"ours", "embree"});
}

TEST_CASE("scaling: queries that found other distances did other work") {
    sim::ScalingStudy study;
    study.row = {row("1k", "ours", 0, 50.0, 1.0), row("1k", "embree", 0, 50.0, 1.000001),
                 row("1k", "ours+contact", 0, 50.0, 0.0)}; // a whole tick has none to compare
    CHECK(sim::answers_agree(study, "1k"));
    study.row.push_back(row("1k", "wrong", 0, 50.0, 1.0001));
    CHECK(!sim::answers_agree(study, "1k"));
    sim::ScalingOptions o;
    o.sizes = {"1k"};
    const std::string page = text_of(sim::scaling_files(o, study), "scaling.md");
    CHECK(page.find("not the same") != std::string::npos);
}

TEST_CASE("scaling: all take turns, a missing peer is a gap with its reason") {
    sim::ScalingOptions o;
    o.sizes = {"200", "500"};
    o.methods = {"brute-force"};
    o.contacts = {"penalty"};
    o.peers = {"absent"};
    o.peer_dir = "/no/such/place";
    o.rounds = 2;
    o.seconds = 0.5;
    o.cold_every = 0;
    std::vector<std::string> heard;
    const auto study =
        sim::run_scaling_study(o, [&](const auto& r) { heard.push_back(r.size + r.name); });
    CHECK(heard == std::vector<std::string>{"200brute-force", "200brute-force+penalty",
                                            "500brute-force", "500brute-force+penalty",
                                            "200brute-force+penalty", "200brute-force",
                                            "500brute-force+penalty", "500brute-force"});
    REQUIRE(study.gap.size() == 1);
    CHECK(study.gap[0].first == "absent");
    CHECK(study.row[0].triangles == 180);
    CHECK(study.row[0].contact_ticks > 0);
    const auto files = sim::scaling_files(o, study);
    const std::string page = text_of(files, "scaling.md");
    CHECK(page.find("Missing: absent: /no/such/place/absent_peer is not there") !=
          std::string::npos);
    CHECK(page.find("found the same distances") != std::string::npos);
    CHECK(page.find("Growth from 200 to 500") != std::string::npos);
    CHECK(page.find("Initial radius of every closest-point query: 10 mm") != std::string::npos);
    const std::string csv = text_of(files, "scaling.csv");
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + 8);
    CHECK(text_of(files, "scaling.svg").find("brute-force+penalty, p99") != std::string::npos);
}

TEST_CASE("scaling: unknown names are refused before anything is measured") {
    for (const auto change : {+[](sim::ScalingOptions& o) { o.methods = {"magic"}; },
                              +[](sim::ScalingOptions& o) { o.shape = "liver"; },
                              +[](sim::ScalingOptions& o) { o.rounds = 0; }}) {
        sim::ScalingOptions o;
        change(o);
        CHECK_THROWS_AS(sim::run_scaling_study(o, [](const auto&) {}), std::invalid_argument);
    }
}

TEST_CASE("peer programs: what one prints is taken, what fails is a gap") {
    const auto said = sim::run_peer_program("/bin/echo", {"{\"a\": \"b c\"}", "$HOME"});
    CHECK(said.gap.empty());
    CHECK(said.text == "{\"a\": \"b c\"} $HOME\n"); // no shell in between
    CHECK(sim::run_peer_program("/bin/false", {}).gap.find("ended with 1") != std::string::npos);
    CHECK(sim::run_peer_program("/no/such", {}).gap.find("/no/such") != std::string::npos);
}

TEST_CASE("chart: a straight power law is a straight line, corner to corner") {
    const sim::ChartLine line{"a<b", 0, true, {{1.0, 1.0}, {10.0, 10.0}, {100.0, 100.0}, {5, 0}}};
    const std::string svg = sim::log_log_svg({"t", "x", "y"}, std::span(&line, 1));
    CHECK(svg.find("points=\"80.0,490.0 360.0,270.0 640.0,50.0 \"") != std::string::npos);
    CHECK(svg.find("a&lt;b") != std::string::npos);
    CHECK(svg.find("stroke-dasharray") != std::string::npos);
    CHECK(sim::log_log_svg({"t", "x", "y"}, {}).find("</svg>") != std::string::npos);
}

// tests/sim/rate_choice_test.cpp
// The choice of FEM steps a second: made-up tracks against the gates, and a liver pressed slowly
// and struck.
#include "sim/study/why_study.h"

#include <doctest/doctest.h>

namespace {

using glm::dvec3;

constexpr double kStep_s = 0.01;

// A tool that presses organ 0, every `stride`-th of 200 steps; the force rises by 40 mN in each.
sim::TierTrack pressed(int stride, double force_share) {
    sim::TierTrack track;
    for (int i = 0; i < 200; i += stride) {
        sim::TierSample s{};
        s.body = {0, -1, -1};
        s.force_n[0] = {0.0, 0.0, force_share * 0.04 * (i + 1)};
        track.step.push_back(s);
    }
    return track;
}

sim::WhyStudy pressed_liver(double speed_mps, bool choose_rate) {
    sim::WhyOptions o;
    o.scene = "basic";
    o.motion = {"press"};
    o.speed_mps = speed_mps;
    o.choose_rate = choose_rate;
    return sim::run_why_study(o, nullptr);
}

} // namespace

TEST_CASE("rate: steps are compared where both rates have one") {
    const sim::TierTrack dear = pressed(1, 1.0);
    const sim::TierMargin same = sim::rate_margin(pressed(2, 1.0), dear, 0, 2, kStep_s);
    CHECK(same.steps == 100);
    CHECK(same.windows > 90);
    CHECK(same.worst() == 0.0);
    // 8 % off: the gate is 7 % above 0.5 N, 35 mN at 0.5 N; stiffness is allowed 15 %
    const sim::TierMargin off = sim::rate_margin(pressed(4, 0.92), dear, 0, 4, kStep_s);
    CHECK(off.steps == 50);
    CHECK(off.stiffness == doctest::Approx(0.08 / 0.15).epsilon(1e-9).scale(0.0));
    CHECK_FALSE(off.enough());
}

TEST_CASE("rate: half the steps serve a press, and the words say by how much") {
    const sim::WhyStudy slow = pressed_liver(0.05, true);
    REQUIRE(slow.rate.tried.size() == 1);
    CHECK(slow.rate.hz == 50);
    CHECK(slow.rate.tried[0].margin.front().margin.steps > 20);
    CHECK(sim::why_words(slow).find("50 are enough: liver") != std::string::npos);
}

TEST_CASE("rate: a blow needs every step, and unasked no rate is tried") {
    const sim::WhyStudy blow = pressed_liver(1.0, true);
    REQUIRE(blow.rate.tried.size() == 1);
    CHECK_FALSE(blow.rate.tried[0].enough());
    CHECK(blow.rate.hz == 100);
    CHECK(sim::why_words(blow).find("50 are not: liver") != std::string::npos);
    const sim::WhyStudy unasked = pressed_liver(0.05, false);
    CHECK(unasked.rate.tried.empty());
    CHECK(unasked.rate.hz == 100);
}

TEST_CASE("rate: what cannot be solved, or makes an attempt invalid, is not enough") {
    sim::TriedRate tried{.hz = 50};
    CHECK(tried.enough());
    tried.fault = "the expert's attempt at find-tubes then has the fault \"x\"";
    CHECK_FALSE(tried.enough());
    CHECK(sim::words_of(sim::RateChoice{100, 100, {tried}}).find("50 are not: the expert's") !=
          std::string::npos);
    tried.fault.clear();
    tried.linear_residual = 0.2;
    CHECK_FALSE(tried.enough());
    CHECK(sim::words_of(sim::RateChoice{100, 100, {tried}}).find("unsolved") != std::string::npos);
}

// tests/sim/tier_choice_test.cpp
// The choice of tiers: made-up tracks against the gates, and real ones of a liver and a board.
#include "sim/io/files.h"
#include "sim/study/auto_model.h"
#include "sim/study/why_study.h"

#include <doctest/doctest.h>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace {

using glm::dvec3;
using tissue::Tier;

constexpr double kStep_s = 0.01;
constexpr std::size_t kTiers = tissue::kTierNames.size();

// A tool that presses organ 0 for 100 steps, the force rising by 25 mN a step to 2.5 N.
sim::TierTrack pressed(double force_share, double skin_m) {
    sim::TierTrack track;
    for (int i = 1; i <= 100; ++i) {
        sim::TierSample s{};
        s.body = {0, -1, -1};
        s.force_n[0] = {0.0, 0.0, force_share * 0.025 * i};
        s.skin_m[0] = {0.0, 0.0, skin_m};
        track.step.push_back(s);
    }
    return track;
}

std::string enough(const std::array<sim::TierTrack, kTiers>& track) {
    return std::string(tissue::name_of(sim::choose_tier(track, 0, "organ", kStep_s).tier));
}

sim::WhyOptions press_of_liver() {
    sim::WhyOptions o;
    o.scene = "basic";
    o.motion = {"press"};
    o.fem_hz = 50;
    return o;
}

void quiet(const std::string&) {}

} // namespace

TEST_CASE("tier choice: force is allowed 7 % above half a newton and 35 mN below") {
    const sim::TierTrack truth = pressed(1.0, 0.0);
    // 3 % off, of 7 % in force and of 15 % in stiffness
    const sim::TierMargin little = sim::tier_margin(pressed(1.03, 0.0), truth, 0, kStep_s);
    CHECK(little.steps == 100);
    CHECK(little.force == doctest::Approx(0.03 / 0.07).epsilon(1e-9).scale(0.0));
    CHECK(little.stiffness == doctest::Approx(0.03 / 0.15).epsilon(1e-9).scale(0.0));
    CHECK(little.enough());
    // 8 % off: outside above 0.5 N, and 40 mN off at 0.5 N
    const sim::TierMargin more = sim::tier_margin(pressed(0.92, 0.0), truth, 0, kStep_s);
    CHECK(more.force == doctest::Approx(0.04 / 0.035).epsilon(1e-9).scale(0.0));
    CHECK_FALSE(more.enough());
}

TEST_CASE("tier choice: one step in a hundred may be far off, two may not") {
    const sim::TierTrack truth = pressed(1.0, 0.0);
    sim::TierTrack other = truth;
    other.step[50].skin_m[0].z += 5e-3;
    CHECK(sim::tier_margin(other, truth, 0, kStep_s).position > 1.0); // of 100, the 99th of 0..99
    other = truth;
    CHECK(sim::tier_margin(other, truth, 0, kStep_s).position == 0.0);
    other.step[10].skin_m[0].z += 0.6e-3;
    other.step[11].skin_m[0].z += 0.6e-3;
    CHECK_FALSE(sim::tier_margin(other, truth, 0, kStep_s).enough());
}

TEST_CASE("tier choice: the cheapest that no dearer tier contradicts") {
    const sim::TierTrack right = pressed(1.0, 0.0), soft = pressed(0.8, 0.0),
                         sunk = pressed(1.0, 1e-3);
    CHECK(enough({right, right, right, right}) == "rigid");
    CHECK(enough({sunk, right, right, right}) == "linear-compliance");
    CHECK(enough({sunk, soft, right, right}) == "corotated");
    // the next tier alone would say that it is enough: both lock alike
    CHECK(enough({sunk, soft, soft, right}) == "quadratic");
    // a tier that is not finite is none
    sim::TierTrack broken = right;
    broken.step[3].force_n[0].x = std::nan("");
    CHECK(enough({sunk, broken, right, right}) == "corotated");
}

TEST_CASE("tier choice: an organ that nothing touches stays as it usually is") {
    const sim::TierTrack right = pressed(1.0, 0.0);
    const std::array<sim::TierTrack, kTiers> all{right, right, right, right};
    const sim::OrganChoice other = sim::choose_tier(all, 1, "other", kStep_s);
    CHECK_FALSE(other.touched);
    CHECK(other.tier == sim::kUsualTier);
    CHECK(sim::words_of(other).find("no tool touches it") != std::string::npos);
}

TEST_CASE("why: a board is rigid, a light press linear, one four times as deep is not") {
    sim::WhyOptions o = press_of_liver();
    const std::string light = sim::run_why_study(o, nullptr).model;
    CHECK(light == "linear-compliance");
    o.depth_scale = 4.0;
    CHECK(sim::run_why_study(o, nullptr).model == "quadratic");
    o.depth_scale = 0.1;
    o.young_pa = 1e9;
    CHECK(sim::run_why_study(o, nullptr).model == "rigid");
}

TEST_CASE("why: what cannot be done is said") {
    sim::WhyOptions o = press_of_liver();
    o.organ = "stomach";
    CHECK_THROWS_WITH(sim::run_why_study(o, nullptr), doctest::Contains("has soft organs liver"));
    o = press_of_liver();
    o.fem_hz = 30;
    CHECK_THROWS_WITH(sim::run_why_study(o, nullptr), doctest::Contains("must divide 1000"));
    o = press_of_liver();
    o.depth_scale = -1.0;
    CHECK_THROWS_WITH(sim::run_why_study(o, nullptr), doctest::Contains("must be above 0"));
}

TEST_CASE("auto: a choice is made once, and damaged memory is begun anew") {
    const auto memory = std::filesystem::temp_directory_path() /
                        ("trocar-models-" + std::to_string(getpid()) + ".json");
    std::filesystem::remove(memory);
    sim::RunOptions o;
    o.exercise = "touch-points";
    o.fem_hz = 20;
    sim::write_text(memory, "{ not JSON");
    const sim::AutoModel first = sim::auto_model(o, false, memory, quiet);
    CHECK_FALSE(first.remembered);
    const sim::AutoModel again = sim::auto_model(o, false, memory, quiet);
    CHECK(again.remembered);
    CHECK(again.model == first.model);
    CHECK(again.why == first.why);
    // what was remembered is a model that a session takes
    const std::array<std::string, 2> organ{"liver", "wall"};
    CHECK_NOTHROW(sim::parse_model(first.model, organ));
    CHECK(nlohmann::json::parse(sim::read_text(memory)).size() == 1);
    std::filesystem::remove(memory);
}

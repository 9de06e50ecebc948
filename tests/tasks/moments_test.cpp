#include "tasks/score/moments.h"

#include "relative.h"
#include "scored.h"

using namespace tasks;
using namespace tasks::testing;

namespace {

// The right tool moves slowly, so that nobody rests, unless `at` says otherwise.
constexpr double kStroll_mps = 0.005;

std::vector<Moment> moments(int n, const Motion& at, ScoreContext context = {}) {
    const Scored s = scored(n, [&](Observation& seen, double t_s) {
        seen.tool[1].tip_m.y += kStroll_mps * t_s;
        at(seen, t_s);
    });
    return worst_moments(s.score, s.progress, with_ideal_path(std::move(context), two_points()));
}

bool within(double t_s, double from_s, double to_s) {
    return t_s > from_s - 1e-6 && t_s < to_s - 1e-6;
}

} // namespace

TEST_CASE("an attempt without a mistake, a touch or a pause has no worst moment") {
    CHECK(moments(3000, [](Observation&, double) {}).empty());
    CHECK(worst_moments({}, {}, {}).empty());
}

TEST_CASE("too much force is shown where the limit was passed, with the largest force after it") {
    const auto found = moments(6000, [](Observation& seen, double t_s) {
        if (within(t_s, 2.0, 2.5)) // 2.1 N at once, 3 N at the end
            touch(seen, Role::left, {0.03, 0.0, 0.0}, t_s < 2.3 ? 2.1 : 3.0);
    });
    REQUIRE(found.size() == 1); // the largest force was over the limit: the same moment
    CHECK(found[0].kind == "over_force");
    CHECK(found[0].tick == 2000);
    CHECK(found[0].tool == 0);
    CHECK(found[0].place_m.x == 0.03);
    CHECK(found[0].badness == relative(2.0 + 3.0 / 2.0, 1e-6));
    CHECK(found[0].text == "The left tool pressed with 3.0 N. The limit is 2.0 N.");
}

TEST_CASE("a wrong tool and a touch off target are told in plain words") {
    const auto found = moments(9000, [](Observation& seen, double t_s) {
        if (within(t_s, 2.0, 3.0)) // point 1 is the right tool's
            touch(seen, Role::left, {0.0, 0.0, 0.0}, 0.3);
        if (within(t_s, 6.0, 7.0))
            touch(seen, Role::assist, {-0.05, 0.0, 0.0}, 0.3);
    });
    REQUIRE(found.size() >= 2);
    CHECK(found[0].kind == "wrong_role"); // both weigh the same: the earlier one first
    CHECK(found[0].text == "The left tool touched point 1, which is for the right tool.");
    CHECK(found[1].kind == "off_target");
    CHECK(found[1].text == "The assist tool touched the tissue in a wrong place.");
}

TEST_CASE("time out of the picture counts to its end") {
    const auto found = moments(9000, [](Observation& seen, double t_s) {
        if (within(t_s, 2.0, 4.5))
            seen.tool[2].tip_m = {5.0 + kStroll_mps * t_s, 0.0, 0.1};
    });
    REQUIRE(found.size() == 1);
    CHECK(found[0].kind == "out_of_view");
    CHECK(found[0].tool == 2);
    CHECK(found[0].text == "The assist tool worked outside the picture for 2.5 s.");
    CHECK(found[0].badness == 3.0);
}

TEST_CASE("without errors the largest force and the longest hesitation are shown") {
    const auto at = [](Observation& seen, double t_s) {
        if (within(t_s, 1.0, 1.4))
            touch(seen, Role::right, {0.0, 0.0, 0.0}, within(t_s, 1.2, 1.201) ? 0.9 : 0.3);
        // still from 4 s to 7 s, and for 1.5 s from 8 s on
        const double gone_s = t_s < 4.0   ? t_s
                              : t_s < 7.0 ? 4.0
                              : t_s < 8.0 ? t_s - 3.0
                                          : std::max(5.0, t_s - 4.5);
        if (t_s >= 4.0)
            seen.tool[1].tip_m.y = kStroll_mps * gone_s;
    };
    const auto found = moments(12000, at);
    REQUIRE(found.size() == 2);
    CHECK(found[0].kind == "largest_force");
    CHECK(found[0].tick == 1200);
    CHECK(found[0].badness == relative(0.9 / 2.0, 1e-6));
    CHECK(found[0].text == "Largest force: the right tool pressed with 0.90 N.");
    CHECK(found[1].kind == "hesitation");
    CHECK(found[1].tool == 1); // it went on
    // Still is less than 2 mm/s over 100 ms: 40 ms of 5 mm/s are enough to be moving.
    CHECK(found[1].tick == relative(4060, 1e-3));
    CHECK(found[1].badness == relative(0.1 * (3.0 - 0.06 + 0.04), 0.01));

    ScoreContext unfelt;
    unfelt.forces_on = false;
    CHECK(moments(12000, at, unfelt).at(0).kind == "hesitation");
}

TEST_CASE("the worst three are kept, worst first, two seconds apart") {
    const auto found = moments(20000, [](Observation& seen, double t_s) {
        const double peak[] = {2.2, 2.6, 3.2, 2.4, 4.0};
        for (int k = 0; k < 5; ++k) // at 2, 3.5, 5, 6.5 and 15 s
            if (const double from = k < 4 ? 2.0 + 1.5 * k : 15.0; within(t_s, from, from + 0.2))
                touch(seen, Role::right, {0.0, 0.0, 0.0}, peak[k]);
    });
    REQUIRE(found.size() == 3);
    CHECK(found[0].tick == 15000);
    CHECK(found[1].tick == 5000); // 3.5 s and 6.5 s are nearer than two seconds
    CHECK(found[2].tick == 2000);
    for (std::size_t i = 0; i + 1 < found.size(); ++i)
        CHECK(found[i].badness >= found[i + 1].badness);
}

TEST_CASE("several mistakes in one second weigh more than one") {
    const auto found = moments(9000, [](Observation& seen, double t_s) {
        if (within(t_s, 2.0, 2.2))
            touch(seen, Role::right, {0.0, 0.0, 0.0}, 3.0);
        if (within(t_s, 6.0, 6.2)) {
            touch(seen, Role::right, {0.0, 0.0, 0.0}, 2.2);
            touch(seen, Role::assist, {0.0, 0.03, 0.0}, 2.2);
        }
    });
    REQUIRE(found.size() == 2);
    CHECK(found[0].tick == 6000);
    CHECK(found[0].tool == 1); // equal: the lower tool
    CHECK(found[0].badness >= 2.0 * (2.0 + 2.2 / 2.0) - 1e-6);
}

// tests/sim/step_thread_test.cpp
// FEM steps beside the ticks: the bits of one thread, and no race, for the thread sanitizer.
#include "sim/session/step_thread.h"

#include <doctest/doctest.h>
#include <string>

namespace {

std::unique_ptr<sim::Session> session(const char* exercise = "touch-points") {
    sim::RunOptions options;
    options.exercise = exercise;
    options.seed = 3;
    options.hands = "expert";
    options.max_seconds = 3.0;
    return sim::make_session(options);
}

// The tools as they lie, one of them lowered into the tissue step by step.
sim::ToolsNow tools_at(const sim::Session& s, int step) {
    sim::ToolsNow tools;
    tools.tick = 10 * step;
    for (int i = 0; i < sim::kTools; ++i) {
        tools.tip[i].radius_m = 3e-3;
        tools.tip[i].centre_m = glm::dvec3{0.2, 0.0, 0.2};
    }
    const sim::Body& body = s.tissue.bodies.front();
    tools.tip[0].centre_m = body.skin_m.front() + (3e-3 - 2e-4 * step) * body.skin_normal.front();
    return tools;
}

bool same(const tasks::StepTrace& a, const tasks::StepTrace& b) {
    return a.step == b.step && a.sample_tick == b.sample_tick && a.target_um == b.target_um &&
           a.stress_pa == b.stress_pa && a.clear_rays == b.clear_rays && a.flags == b.flags;
}

} // namespace

TEST_CASE("step thread: steps and answers are those of one thread, to the bit") {
    const auto one = session(), two = session();
    sim::StepThread steps(*two);
    for (int k = 0; k < 12; ++k) {
        CAPTURE(k);
        sim::TissueAnswer& answer = one->exchange->answers.back();
        const tasks::StepTrace here = run_step(*one, tools_at(*one, k), answer);
        steps.begin(tools_at(*two, k));
        CHECK(same(steps.end(), here));
        const sim::TissueAnswer& there = two->exchange->answers.back();
        CHECK(there.local.step == answer.local.step);
        REQUIRE(there.local.modes == answer.local.modes);
        for (int m = 0; m < answer.local.modes; ++m) {
            CHECK(there.local.lambda[m] == answer.local.lambda[m]);
            CHECK(there.local.residual[m] == answer.local.residual[m]);
        }
        CHECK(there.seen.stress_pa == answer.seen.stress_pa);
        one->exchange->answers.publish();
        two->exchange->answers.publish();
    }
    CHECK(one->tissue.contact[0].force_n == two->tissue.contact[0].force_n);
    CHECK(glm::dot(one->tissue.contact[0].force_n, one->tissue.contact[0].force_n) > 0.0);
}

TEST_CASE("step thread: what is destroyed while its step is made waits for it") {
    const auto s = session();
    for (int k = 0; k < 5; ++k) {
        sim::StepThread steps(*s);
        steps.begin(tools_at(*s, k));
    }
    CHECK(s->tissue.next_step == 5);
}

TEST_CASE(
    "step thread: an attempt of counted time is the same to the bit, whoever waits for whom") {
    for (const char* exercise : {"touch-points", "find-tubes"}) {
        CAPTURE(exercise);
        const auto one = session(exercise), two = session(exercise);
        const std::string hash = run_lockstep(*one, nullptr, 0).row.log_sha256;
        CHECK(run_lockstep(*two, nullptr, 0).row.log_sha256 == hash);
        CHECK(one->tissue.next_step > 100);
    }
}

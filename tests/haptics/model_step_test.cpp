#include "haptics/contact/model_step.h"

#include "tests/haptics/hand_made_models.h"
#include "tests/haptics/sneddon_table.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <random>
#include <rapidcheck.h>

namespace {

using haptics::CouplingResult;
using haptics::CouplingState;
using haptics::kTools;
using haptics::LocalModels;
using haptics::PoseHistory;
using haptics::RunningModel;
using haptics::ToolTip;
using Tips = std::array<ToolTip, kTools>;

constexpr double kTipRadius_m = 3e-3;

const haptics::IndenterTable& table() {
    static const haptics::IndenterTable t = sneddon_table(SneddonSphere{});
    return t;
}

glm::dvec3 place_of(const LocalModels& models, int tool, const haptics::SurfacePoint& at) {
    glm::dvec3 p{0.0};
    const haptics::ToolPatch& patch = models.tool[tool];
    for (int k = 0; k < 3; ++k)
        p += at.weight[k] * patch.vertex[patch.triangle[at.triangle].vertex[k]].anchor_m;
    return p;
}

// Three tools on one slab of nine modes whose shapes fall off in bumps.
void make_slab(LocalModels& models, std::uint32_t seed) {
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    models.sample_tick = -1;
    models.modes = 9;
    std::array<glm::dvec3, 9> direction;
    std::array<glm::dvec3, 9> centre;
    for (int m = 0; m < 9; ++m) {
        models.lambda[m] = 3e3 * (1 + m) * (1 + m);
        models.damping[m] = 4.0 + 3e-3 * models.lambda[m];
        direction[m] = 4.0 * glm::dvec3{0.5 * uniform(rng), 0.5 * uniform(rng), 1.0};
        centre[m] = 0.02 * glm::dvec3{uniform(rng), uniform(rng), 0.0};
    }
    for (int i = 0; i < kTools; ++i) {
        haptics::ToolPatch& patch = models.tool[i];
        make_flat_patch(patch, {0.012 * (i - 1), 0, 0}, 0.03, 12);
        patch.modes = 9;
        patch.friction = 0.1 + 0.1 * i;
        patch.table = &table();
        patch.floor_mpn = 1.25e-3;
        for (int v = 0; v < patch.vertices; ++v)
            for (int m = 0; m < 9; ++m) {
                const double far = glm::length(patch.vertex[v].anchor_m - centre[m]) / 0.02;
                for (int axis = 0; axis < 3; ++axis)
                    patch.shape[v][axis][m] = direction[m][axis] * std::exp(-far * far);
            }
    }
}

// The same system, anchored where `model` has come to: what a perfect FEM would answer.
void republish(const RunningModel& model, LocalModels& out) {
    out = *model.answer;
    out.sample_tick = model.tick;
    for (int m = 0; m < out.modes; ++m) {
        out.residual[m] += out.lambda[m] * model.q[m];
        out.rate[m] = model.rate[m];
    }
    for (int i = 0; i < kTools; ++i) {
        haptics::ToolPatch& patch = out.tool[i];
        for (int v = 0; v < patch.vertices; ++v)
            for (int axis = 0; axis < 3; ++axis)
                for (int m = 0; m < patch.modes; ++m)
                    patch.vertex[v].anchor_m[axis] += patch.shape[v][axis][m] * model.q[m];
        patch.contact = model.contact[i];
        patch.memory = model.memory[i];
        patch.force_n = model.force_n[i];
    }
}

Tips scrubbing(int tick) {
    Tips tips;
    for (int i = 0; i < kTools; ++i) {
        const double t = 1e-3 * tick;
        tips[i] = {{0.012 * (i - 1) + 8e-3 * std::sin(12.0 * t + i), 6e-3 * std::sin(17.0 * t),
                    kTipRadius_m - 1.5e-3 - 2e-3 * std::sin(20.0 * t + 2 * i)},
                   kTipRadius_m};
    }
    return tips;
}

} // namespace

TEST_CASE("model step: a body anchored anew where it is moves on as if nothing had happened") {
    const auto first = empty_models();
    make_slab(*first, 1);
    std::array<std::unique_ptr<LocalModels>, 3> slot{empty_models(), empty_models(),
                                                     empty_models()};
    CouplingState straight;
    CouplingState renewed;
    PoseHistory history;
    adopt(straight, *first);
    adopt(renewed, *first);
    std::mt19937 rng(2);
    LocalModels* answer = nullptr;
    int next = 0;
    int arrives = -1;
    int touching = 0;
    for (int tick = 0; tick < 600; ++tick) {
        if (tick == arrives)
            adopt(renewed, *answer);
        history.push(tick, scrubbing(tick));
        const CouplingResult a = anchored_tick(straight, {}, history, tick);
        const CouplingResult b = anchored_tick(renewed, {}, history, tick);
        for (int i = 0; i < kTools; ++i) {
            REQUIRE(glm::length(a.force_n[i] - b.force_n[i]) < 1e-8);
            touching += a.touching[i];
        }
        if (tick >= arrives + 2) { // the next answer, on its way for 10 to 29 ticks
            answer = slot[next++ % 3].get();
            republish(straight.active, *answer);
            arrives = tick + 10 + static_cast<int>(rng() % 20);
        }
    }
    CHECK(next > 20);
    CHECK(touching > 900);
    CHECK(touching < 1800); // contact was also made and lost
}

TEST_CASE(
    "model step: after a step every tip stands as deep in the moved surface as its law says") {
    // each tool moves the others along directions that are not symmetric between them
    std::mt19937 rng(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto models = empty_models();
    models->modes = 6;
    for (int m = 0; m < 6; ++m) {
        models->lambda[m] = 1e4 * (1 + m);
        models->damping[m] = 50.0;
        models->residual[m] = 10.0 * uniform(rng);
        models->rate[m] = 0.05 * uniform(rng);
    }
    for (haptics::ToolPatch& patch : models->tool) {
        make_flat_patch(patch, {0, 0, 0}, 0.04, 8);
        patch.modes = 6;
        patch.friction = 0.2;
        patch.floor_mpn = 1.25e-3;
        patch.table = &table();
        for (int m = 0; m < 6; ++m)
            set_uniform_mode(patch, m, 5.0 * glm::dvec3{uniform(rng), uniform(rng), uniform(rng)});
    }
    RunningModel model{.answer = models.get(), .rate = models->rate};
    for (int i = 0; i < kTools; ++i)
        model.contact[i] = models->tool[i].contact;
    bool rubbed = false;
    for (int step = 0; step < 3; ++step) {
        Tips tips;
        for (int i = 0; i < kTools; ++i)
            tips[i] = {{4e-4 * step, -1e-4 * step * i, kTipRadius_m - 3e-3 - 5e-4 * i},
                       kTipRadius_m};
        const RunningModel before = model;
        step_model(model, 1e-3, tips);

        for (int i = 0; i < kTools; ++i) {
            double surface_m = 0.0;
            for (int m = 0; m < 6; ++m) {
                // q'' + d q' + lambda q + residual = load, backward differences
                double load = -models->residual[m];
                for (int j = 0; j < kTools; ++j)
                    for (int axis = 0; axis < 3; ++axis)
                        load -= models->tool[j].shape[0][axis][m] * model.force_n[j][axis];
                const double d = models->damping[m];
                const double q = (load + before.rate[m] * 1e3 + before.q[m] * (1e6 + d * 1e3)) /
                                 (1e6 + d * 1e3 + models->lambda[m]);
                CHECK(model.q[m] == doctest::Approx(q).scale(0.0).epsilon(1e-9));
                surface_m += models->tool[i].shape[0][2][m] * q;
            }
            REQUIRE(model.force_n[i].z > 0.0);
            rubbed = rubbed || glm::length(glm::dvec2{model.force_n[i]}) > 1e-2;
            const haptics::LocalLaw law{.table = &table(), .floor_mpn = 1.25e-3};
            const double depth_m = kTipRadius_m - (tips[i].centre_m.z - surface_m);
            const double x = std::cbrt(model.force_n[i].z / table().force_scale_n);
            CHECK(haptics::law_at(law, x).depth_m ==
                  doctest::Approx(depth_m).scale(0.0).epsilon(1e-8));
        }
    }
    CHECK(rubbed);
}

TEST_CASE("model step: after every step the tip is ahead of its contact point by the lag alone") {
    const auto models = empty_models();
    make_flat_patch(models->tool[0], {0, 0, 0}, 0.04, 8);
    models->tool[0].friction = 0.3;
    models->tool[0].floor_mpn = 1e-3;
    RunningModel model{.answer = models.get()};
    model.contact[0] = models->tool[0].contact;
    for (int tick = 0; tick < 500; ++tick) {
        // dragged to and fro while the pressure goes up and down
        const glm::dvec3 tip_m{5e-3 * std::sin(0.02 * tick), 3e-3 * std::sin(0.031 * tick),
                               kTipRadius_m - 1e-3 + 0.5e-3 * std::sin(0.05 * tick)};
        Tips tips;
        tips[0] = {tip_m, kTipRadius_m};
        step_model(model, 1e-3, tips);
        glm::dvec3 ahead_m = tip_m - place_of(*models, 0, model.contact[0]);
        ahead_m.z = 0.0;
        CHECK(glm::length(ahead_m - model.memory[0].lag_m) < 1e-12);
    }
}

TEST_CASE("model step: whatever the answers say, the force never pulls") {
    CHECK(rc::check([] {
        const auto seed = *rc::gen::arbitrary<std::uint32_t>();
        std::mt19937 rng(seed);
        std::uniform_real_distribution<double> uniform(-1.0, 1.0);
        const glm::dvec3 normal =
            glm::normalize(glm::dvec3{uniform(rng), uniform(rng), uniform(rng) + 1.2});
        std::array<std::unique_ptr<LocalModels>, 3> slot{empty_models(), empty_models(),
                                                         empty_models()};
        const auto randomize = [&](LocalModels& m, int tick) {
            make_slab(m, static_cast<std::uint32_t>(rng()));
            m.sample_tick = tick - 1 - static_cast<int>(rng() % 30);
            for (int k = 0; k < m.modes; ++k) {
                m.rate[k] = 0.2 * uniform(rng);
                m.residual[k] = 100.0 * uniform(rng);
            }
            for (haptics::ToolPatch& patch : m.tool) {
                patch.near = rng() % 5 != 0;
                patch.friction = 0.5 + 0.5 * uniform(rng);
                patch.table = rng() % 2 == 0 ? &table() : nullptr;
                for (int v = 0; v < patch.vertices; ++v) {
                    patch.vertex[v].anchor_m +=
                        1e-3 * glm::dvec3{uniform(rng), uniform(rng), 3.0 * uniform(rng)};
                    patch.vertex[v].normal = normal;
                }
                patch.contact.triangle = static_cast<int>(rng() % patch.triangles);
                patch.memory.touching = rng() % 2 == 0;
                patch.memory.x = 0.5 + 0.5 * uniform(rng);
                patch.memory.friction_n = {uniform(rng), uniform(rng), uniform(rng)};
                patch.memory.lag_m = 1e-3 * glm::dvec3{uniform(rng), uniform(rng), uniform(rng)};
            }
        };
        CouplingState state;
        PoseHistory history;
        int next = 0;
        for (int tick = 0; tick < 60; ++tick) {
            if (tick % 7 == 0 && !state.pending.answer) {
                LocalModels& answer = *slot[next++ % 3];
                randomize(answer, tick);
                adopt(state, answer);
            }
            Tips tips;
            for (int i = 0; i < kTools; ++i)
                tips[i] = {{0.012 * (i - 1) + 5e-3 * uniform(rng), 5e-3 * uniform(rng),
                            5e-3 * uniform(rng)},
                           kTipRadius_m};
            history.push(tick, tips);
            const CouplingResult r = anchored_tick(state, {}, history, tick);
            for (int i = 0; i < kTools; ++i) {
                RC_ASSERT(std::isfinite(glm::length(r.force_n[i])));
                RC_ASSERT(glm::dot(r.force_n[i], normal) >= -1e-12);
                RC_ASSERT(r.touching[i] || r.force_n[i] == glm::dvec3{0.0});
            }
        }
    }));
}

TEST_CASE("model step: the foot point stays under a tool that circles far above a small ball") {
    // octahedron split twice, 3 mm, seen from 10 mm: a whole step along the surface would
    // overshoot by more than it corrects
    constexpr double kBall_m = 3e-3;
    const auto models = empty_models();
    haptics::ToolPatch& patch = models->tool[0];
    patch.near = true;
    patch.floor_mpn = 1e-3;
    constexpr int kSide = 4; // each face of the octahedron: kSide^2 triangles
    const auto vertex_of = [&patch](glm::dvec3 p) {
        p = glm::normalize(p);
        for (int v = 0; v < patch.vertices; ++v)
            if (glm::length(patch.vertex[v].normal - p) < 1e-9)
                return static_cast<std::int16_t>(v);
        patch.vertex[patch.vertices] = {.anchor_m = kBall_m * p, .normal = p};
        return static_cast<std::int16_t>(patch.vertices++);
    };
    for (int face = 0; face < 8; ++face) {
        const glm::dvec3 sign{face & 1 ? -1 : 1, face & 2 ? -1 : 1, face & 4 ? -1 : 1};
        const bool flip = sign.x * sign.y * sign.z < 0;
        const auto point = [&](int i, int j) {
            return vertex_of(sign * glm::dvec3{i, j, kSide - i - j});
        };
        for (int i = 0; i < kSide; ++i)
            for (int j = 0; i + j < kSide; ++j) {
                const auto add = [&](std::int16_t a, std::int16_t b, std::int16_t c) {
                    patch.triangle[patch.triangles++].vertex =
                        flip ? std::array{a, c, b} : std::array{a, b, c};
                };
                add(point(i, j), point(i + 1, j), point(i, j + 1));
                if (i + j + 1 < kSide)
                    add(point(i + 1, j), point(i + 1, j + 1), point(i, j + 1));
            }
    }
    for (int t = 0; t < patch.triangles; ++t)
        for (int k = 0; k < 3; ++k)
            for (int u = 0; u < patch.triangles; ++u)
                for (int l = 0; l < 3; ++l)
                    if (patch.triangle[t].vertex[(k + 1) % 3] ==
                            patch.triangle[u].vertex[(l + 2) % 3] &&
                        patch.triangle[t].vertex[(k + 2) % 3] ==
                            patch.triangle[u].vertex[(l + 1) % 3])
                        patch.triangle[t].neighbour[k] = static_cast<std::int16_t>(u);
    patch.contact = {0, glm::dvec3{1.0 / 3.0}};

    RunningModel model{.answer = models.get()};
    model.contact[0] = patch.contact;
    double worst_rad = 0.0;
    for (int tick = 0; tick < 3000; ++tick) {
        const double angle = 2e-3 * tick;
        const glm::dvec3 up = glm::normalize(
            glm::dvec3{std::cos(angle), std::sin(angle), 0.8 * std::sin(1.7 * angle)});
        Tips tips;
        tips[0] = {10e-3 * up, kTipRadius_m};
        step_model(model, 1e-3, tips);
        const glm::dvec3 foot = glm::normalize(place_of(*models, 0, model.contact[0]));
        if (tick > 50)
            worst_rad = std::max(worst_rad, std::acos(glm::dot(foot, up)));
    }
    // facets of 23 degrees: the foot of a flat facet may be half of that from the radius
    CHECK(worst_rad < 0.2);
}

#include "sim/study/hcollide_study.h"

#include "haptics/collision/index.h"
#include "haptics/collision/witness.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>
#include <random>

namespace sim {
namespace {

using glm::dvec3;
using haptics::CollisionIndex;
using haptics::MeshView;
using haptics::SurfaceHit;
using haptics::VisitCounts;
using Clock = std::chrono::steady_clock;

constexpr int kBlock = 50;            // ticks between two deformations
constexpr double kSphere_m = 1e-3;    // of the intersection queries
constexpr double kClearance_m = 2e-4; // of the proxy over the surface

/// One tick of the probe: H-Collide's segment from where the proxy was to where the tip is, and
/// the place of the sphere.
struct Tick {
    dvec3 from_m, to_m, sphere_m;
};

struct Answers {
    std::uint32_t cast = haptics::kNoSurface, closest = haptics::kNoSurface;
    bool operator==(const Answers&) const = default;
};

/// A tip that wanders over the surface at 0.1 to 0.3 m/s and goes in and out by 2 mm at 4 Hz; in
/// contact a proxy stays outside.
std::vector<Tick> make_path(const MeshView& mesh, const HcollideOptions& o) {
    const haptics::ObbTree tree = haptics::make_obb_tree(mesh);
    std::mt19937_64 engine(o.seed);
    const auto uniform = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
    const auto heading = [&] { return dvec3{uniform(), uniform(), uniform()} - 0.5; };
    std::vector<Tick> path;
    std::uint32_t at = static_cast<std::uint32_t>(engine() % mesh.triangle.size());
    dvec3 anchor = mesh.corners(at)[0], way = heading(), normal{0.0, 0.0, 1.0}, proxy = anchor;
    for (int tick = 0; tick < o.queries; ++tick) {
        const auto [a, b, c] = mesh.corners(at);
        dvec3 n = glm::cross(b - a, c - a);
        n = glm::dot(n, n) > 0.0 ? glm::normalize(n) : normal;
        normal = glm::dot(n, normal) < 0.0 ? -n : n;
        if (tick % 200 == 0)
            way = heading();
        if (tick % 1000 == 999) { // lifted and put down elsewhere
            at = static_cast<std::uint32_t>(engine() % mesh.triangle.size());
            anchor = mesh.corners(at)[0];
        }
        const dvec3 along = way - normal * glm::dot(way, normal);
        const double speed_mps = 0.2 + 0.1 * std::sin(0.003 * tick);
        const dvec3 next = anchor + 1e-3 * speed_mps * along / std::max(glm::length(along), 1e-9);
        const SurfaceHit near = closest_within(tree, mesh, next, 1.0);
        if (glm::length(near.place_m - anchor) < 2e-5) // at a rim
            way = heading();
        anchor = near.place_m;
        at = near.triangle;
        const double height_m = 2e-3 * std::sin(2.0 * std::numbers::pi * 4e-3 * tick);
        const dvec3 tip = anchor + height_m * normal;
        const dvec3 last = proxy;
        proxy = anchor + std::max(height_m, kClearance_m) * normal;
        path.push_back({last, tip, proxy});
    }
    return path;
}

/// The whole space waves, mesh and path: 1 mm, 40 mm long, in steps.
dvec3 deformed(const dvec3& p, int pose) noexcept {
    return p + 1e-3 * glm::sin(157.0 * dvec3{p.y, p.z, p.x} + 0.3 * pose);
}

/// One method, asked with or without a witness.
struct Contestant {
    CollisionIndex index;
    std::array<haptics::Witness, 2> last; // of casts, of spheres
    std::array<HcollideRow, 2> row;       // without, with
};

template <class Method>
SurfaceHit cast(const Method& m, const MeshView& mesh, const Tick& t, haptics::Witness* w) {
    return w ? cast_segment_cached(m, mesh, t.from_m, t.to_m, *w)
             : cast_segment(m, mesh, t.from_m, t.to_m);
}

template <class Method>
SurfaceHit touch(const Method& m, const MeshView& mesh, const Tick& t, haptics::Witness* w) {
    return w ? closest_within_cached(m, mesh, t.sphere_m, kSphere_m, *w)
             : closest_within(m, mesh, t.sphere_m, kSphere_m);
}

double us(Clock::duration d) {
    return 1e6 * std::chrono::duration<double>(d).count();
}

struct BlockTimes {
    std::array<double, kBlock> cast_us, touch_us;
};

/// Asks all of a block; keeps the lesser of old and new times.
template <class Method>
void time_block(const Method& m, const MeshView& mesh, std::span<const Tick> block,
                std::array<haptics::Witness, 2>* last, std::span<Answers> answers,
                BlockTimes& times) {
    for (std::size_t i = 0; i < block.size(); ++i) {
        const auto start = Clock::now();
        const SurfaceHit a = cast(m, mesh, block[i], last ? &(*last)[0] : nullptr);
        times.cast_us[i] = std::min(times.cast_us[i], us(Clock::now() - start));
        answers[i].cast = a.triangle;
    }
    for (std::size_t i = 0; i < block.size(); ++i) {
        const auto start = Clock::now();
        const SurfaceHit b = touch(m, mesh, block[i], last ? &(*last)[1] : nullptr);
        times.touch_us[i] = std::min(times.touch_us[i], us(Clock::now() - start));
        answers[i].closest = b.triangle;
    }
}

/// Apart from the timing, so that counting costs nothing there.
template <class Method>
void count_block(const Method& m, const MeshView& mesh, std::span<const Tick> block,
                 std::array<haptics::Witness, 2>* last, VisitCounts& counts) {
    const haptics::Counted<Method> counted{m, counts};
    for (const Tick& t : block) {
        cast(counted, mesh, t, last ? &(*last)[0] : nullptr);
        touch(counted, mesh, t, last ? &(*last)[1] : nullptr);
    }
}

void add_times(HcollideRow& row, const BlockTimes& times, std::span<const Answers> answers,
               std::span<const Answers> first) {
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const bool hit = answers[i].cast != haptics::kNoSurface;
        const bool near = answers[i].closest != haptics::kNoSurface;
        row.kind[hit ? 0 : 1].add(times.cast_us[i]);
        row.kind[near ? 2 : 3].add(times.touch_us[i]);
        row.all.add(times.cast_us[i]);
        row.all.add(times.touch_us[i]);
        row.different += answers[i] != first[i];
    }
}

/// All contestants on one block, by turns; each begins a round as it began the block.
void run_block(std::vector<Contestant>& all, const MeshView& mesh, std::span<const Tick> block,
               int rounds) {
    std::vector<std::array<BlockTimes, 2>> times(all.size());
    for (auto& both : times)
        for (BlockTimes& t : both) {
            t.cast_us.fill(1e9);
            t.touch_us.fill(1e9);
        }
    std::vector<std::array<std::vector<Answers>, 2>> answers(
        all.size(), {std::vector<Answers>(block.size()), std::vector<Answers>(block.size())});
    for (int round = 0; round < rounds; ++round)
        for (std::size_t turn = 0; turn < 2 * all.size(); ++turn) {
            const std::size_t who = (turn + round) % (2 * all.size());
            Contestant& c = all[who / 2];
            const bool with = who % 2 == 1;
            std::array<std::uint32_t, 2> kept{c.last[0].triangle, c.last[1].triangle};
            std::visit(
                [&](const auto& m) {
                    time_block(m, mesh, block, with ? &c.last : nullptr, answers[who / 2][with],
                               times[who / 2][with]);
                },
                c.index);
            c.last[0].triangle = kept[0];
            c.last[1].triangle = kept[1];
        }
    for (std::size_t i = 0; i < all.size(); ++i)
        for (const bool with : {false, true}) {
            Contestant& c = all[i];
            add_times(c.row[with], times[i][with], answers[i][with], answers[0][0]);
            std::visit(
                [&](const auto& m) {
                    count_block(m, mesh, block, with ? &c.last : nullptr, c.row[with].counts);
                },
                c.index); // and leaves the witnesses where the block ends
        }
}

void run_mesh(const StandIn& stand_in, bool deforming, const std::vector<Tick>& path,
              const HcollideOptions& o, HcollideStudy& study) {
    std::vector<dvec3> vertex = stand_in.vertex_m;
    const MeshView mesh{vertex, stand_in.triangle, {}};
    const haptics::Neighbours neighbours = haptics::make_neighbours(mesh);
    std::vector<Contestant> all;
    for (const std::string_view name : haptics::kCollisionNames) {
        if (name == "brute-force")
            continue;
        HcollideRow row;
        row.mesh = stand_in.name;
        row.method = name;
        row.deforming = deforming;
        HcollideRow with = row;
        with.witness = true;
        all.push_back({haptics::make_index(name, mesh),
                       {haptics::Witness{neighbours}, haptics::Witness{neighbours}},
                       {row, with}});
    }
    std::vector<Tick> block;
    for (std::size_t at = 0; at < path.size(); at += kBlock) {
        const auto now =
            std::span(path).subspan(at, std::min<std::size_t>(kBlock, path.size() - at));
        block.assign(now.begin(), now.end());
        if (deforming) {
            const int pose = static_cast<int>(at / kBlock) + 1;
            for (std::size_t v = 0; v < vertex.size(); ++v)
                vertex[v] = deformed(stand_in.vertex_m[v], pose);
            for (Tick& t : block)
                t = {deformed(t.from_m, pose), deformed(t.to_m, pose), deformed(t.sphere_m, pose)};
            for (Contestant& c : all) {
                const auto start = Clock::now();
                refit(c.index, mesh);
                const double taken_us = us(Clock::now() - start);
                for (HcollideRow& row : c.row)
                    row.refit.add(taken_us);
            }
        }
        run_block(all, mesh, block, o.rounds);
    }
    for (Contestant& c : all)
        for (HcollideRow& row : c.row)
            study.row.push_back(row);
}

double clock_cost_us() {
    double least = 1e9;
    for (int i = 0; i < 1000; ++i) {
        const auto start = Clock::now();
        least = std::min(least, us(Clock::now() - start));
    }
    return least;
}

} // namespace

void QueryCost::add(double us_taken) noexcept {
    ++count;
    sum_us += us_taken;
    worst_us = std::max(worst_us, us_taken);
}

HcollideStudy run_hcollide_study(const HcollideOptions& o,
                                 void (*progress)(const std::string& what)) {
    HcollideStudy study;
    study.clock_us = clock_cost_us();
    for (const StandIn& stand_in : make_stand_ins(o.seed)) {
        const MeshView mesh{stand_in.vertex_m, stand_in.triangle, {}};
        const std::vector<Tick> path = make_path(mesh, o);
        for (const bool deforming : {false, true}) {
            progress(std::string(stand_in.name) + (deforming ? ", deforming" : ", at rest"));
            run_mesh(stand_in, deforming, path, o, study);
        }
    }
    return study;
}

} // namespace sim

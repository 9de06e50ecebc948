#include "assets/bake/import/import.h"

#include "assets/bake/edge_for_nodes.h"
#include "assets/bake/import/clean.h"
#include "assets/bake/import/grouping.h"
#include "assets/bake/import/organ_body.h"
#include "assets/bake/import/read_surface.h"

#include <bit>

namespace bake {
namespace {

// Three tools that press on one organ of some 500 nodes at once take a tissue step of 7 ms (p99,
// one core), of the 10 ms that there are; twice the nodes take 18 ms. Grading makes of these 340
// 410 to 540 of four real organs.
constexpr double kNodes = 340.0; // before grading, of all bodies together, if --edge says nothing
constexpr std::size_t kMostNodes = 700; // of one organ, before it is said

constexpr double kFineShare = 0.5; // of the edge, at places that are asked for
constexpr double kMm = 1e-3;

/// FNV-1a over what decides the organs.
std::uint64_t input_hash(std::span<const std::byte> bytes, const ImportOptions& o) {
    std::uint64_t hash = 0xCBF29CE484222325ULL;
    const auto take = [&](const void* data, std::size_t size) {
        const auto* at = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < size; ++i) {
            hash = (hash ^ at[i]) * 0x100000001B3ULL;
        }
    };
    take(bytes.data(), bytes.size());
    take(o.file_name.data(), o.file_name.size());
    std::vector<double> numbers{static_cast<double>(kImportVersion),
                                static_cast<double>(kBakeVersion),
                                o.unit.m,
                                o.edge_mm,
                                o.rigid ? 1.0 : 0.0,
                                o.largest ? 1.0 : 0.0,
                                o.material.young_pa,
                                o.material.poisson,
                                o.material.density_kgpm3};
    for (const auto& f : o.fine) {
        numbers.insert(numbers.end(),
                       {f.centre_mm.x, f.centre_mm.y, f.centre_mm.z, f.radius_mm, f.edge_mm});
    }
    take(numbers.data(), numbers.size() * sizeof(double));
    return hash;
}

/// From what is there before repair: volume and area of all pieces together.
double choose_edge_m(const Pieces& pieces, const ImportOptions& options) {
    if (options.edge_mm > 0.0) {
        return kMm * options.edge_mm;
    }
    double volume = std::abs(volume_m3(pieces.broken)), area = area_m2(pieces.broken);
    for (const auto& s : pieces.closed) {
        volume += std::abs(volume_m3(s));
        area += area_m2(s);
    }
    return edge_for_nodes(volume, area, kNodes);
}

/// Said, not refused: a thin body needs short edges, and may have no coarse ones.
void judge_size(const ImportedBody& body, Notes& notes) {
    const std::size_t nodes = body.organ.mesh.rest_m.size();
    if (nodes > kMostNodes) {
        notes.problems.push_back(fmt::format(
            "{} has {} nodes: with more than some {}, three tools at once may take it out of real "
            "time; a larger --edge gives fewer where the body is not thin",
            body.organ.name, nodes, kMostNodes));
    }
    if (!body.no_quadratic.empty()) {
        notes.problems.push_back(body.no_quadratic);
    }
}

void keep_largest(std::vector<GivenBody>& bodies, Notes& notes) {
    if (bodies.size() > 1) {
        notes.repairs.push_back(fmt::format("{} smaller bodies dropped as asked (--largest), the "
                                            "next one of {:.3g} ml",
                                            bodies.size() - 1, 1e6 * bodies[1].body.volume_m3));
        bodies.resize(1);
    }
}

} // namespace

std::string organ_name(const std::string& file_name, std::size_t body, std::size_t bodies) {
    const std::size_t slash = file_name.find_last_of('/');
    std::string stem = slash == std::string::npos ? file_name : file_name.substr(slash + 1);
    stem = stem.substr(0, stem.find_last_of('.'));
    for (char& c : stem) {
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
        c = plain ? c : '_';
    }
    stem = stem.empty() ? "organ" : stem.substr(0, 60);
    return bodies > 1 ? fmt::format("{}_{}", stem, body + 1) : stem;
}

Imported import_surface(std::span<const std::byte> bytes, const ImportOptions& asked) {
    ImportOptions options = asked;
    PhaseClock clock(options.tell);
    Imported result;
    result.notes.unit = options.unit;
    clock.begin("read");
    const Soup soup = read_surface(bytes, options.file_name);
    result.format = soup.format;
    result.triangles = soup.triangles.size();
    result.notes.problems = soup.remarks;

    clock.begin("check and repair");
    Pieces pieces = clean(soup, result.notes);
    result.found = pieces.closed.size() + (pieces.broken.triangles.empty() ? 0 : 1);
    const double edge_m = choose_edge_m(pieces, options);
    for (auto& spot : options.fine) {
        spot.edge_mm = kFineShare * edge_m / kMm;
    }
    auto bodies = separate_bodies(std::move(pieces), edge_m, result.notes, clock);
    for (const auto& b : bodies) {
        result.found -= b.body.cavity_m.size();
    }
    if (options.largest) {
        keep_largest(bodies, result.notes);
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const BodyPlan plan{.name = organ_name(options.file_name, i, bodies.size()),
                            .edge_m = edge_m,
                            .hash = input_hash(bytes, options)};
        result.bodies.push_back(
            make_organ(bodies[i].body, bodies[i].seen, plan, options, result.notes, clock));
        judge_size(result.bodies.back(), result.notes);
    }
    clock.end();
    result.phases = clock.phases();
    result.seconds = clock.seconds();
    return result;
}

} // namespace bake

#include "assets/bake/tetrahedralise.h"

#include "assets/bake/child.h"

#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <stdexcept>

#define TETLIBRARY
#include <tetgen.h>

namespace bake {
namespace {

constexpr double kScale = 1e3; // TetGen works in millimetres: its tolerances are absolute in places
constexpr int kMaxAddedPoints = 200'000;

const char* tetgen_reason(int code) {
    switch (code) {
    case 1:
        return "TetGen: out of memory";
    case 3:
        return "TetGen: the surface intersects itself";
    case 4:
        return "TetGen: a detail of the surface is too small";
    case 5:
        return "TetGen: two faces are too close";
    case 10:
        return "TetGen: the input was refused";
    default:
        return "TetGen: internal error";
    }
}

/// In the child. Everything `in` owns is freed by TetGen's own destructor.
void fill_input(const Surface& s, tetgenio& in) {
    in.firstnumber = 0;
    in.numberofpoints = static_cast<int>(s.point_m.size());
    in.pointlist = new REAL[s.point_m.size() * 3];
    for (std::size_t i = 0; i < s.point_m.size(); ++i) {
        for (int d = 0; d < 3; ++d) {
            in.pointlist[3 * i + d] = kScale * s.point_m[i][d];
        }
    }
    in.numberoffacets = static_cast<int>(s.triangles.size());
    in.facetlist = new tetgenio::facet[s.triangles.size()];
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
        tetgenio::facet& facet = in.facetlist[t];
        tetgenio::init(&facet);
        facet.numberofpolygons = 1;
        facet.polygonlist = new tetgenio::polygon[1];
        tetgenio::polygon& polygon = facet.polygonlist[0];
        tetgenio::init(&polygon);
        polygon.numberofvertices = 3;
        polygon.vertexlist = new int[3];
        for (int k = 0; k < 3; ++k) {
            polygon.vertexlist[k] = static_cast<int>(s.triangles[t][k]);
        }
    }
}

template <class T> void put(std::vector<std::byte>& bytes, const T* data, std::size_t count) {
    const auto* first = reinterpret_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), first, first + count * sizeof(T));
}

void fill_cavities(const std::vector<glm::dvec3>& cavity_m, tetgenio& in) {
    if (cavity_m.empty()) {
        return;
    }
    in.numberofholes = static_cast<int>(cavity_m.size());
    in.holelist = new REAL[cavity_m.size() * 3];
    for (std::size_t i = 0; i < cavity_m.size(); ++i) {
        for (int d = 0; d < 3; ++d) {
            in.holelist[3 * i + d] = kScale * cavity_m[i][d];
        }
    }
}

std::vector<std::byte> run_tetgen(const Surface& boundary, const std::vector<glm::dvec3>& cavity_m,
                                  std::string switches) {
    tetgenio in, out;
    fill_input(boundary, in);
    fill_cavities(cavity_m, in);
    try {
        tetrahedralize(switches.data(), &in, &out);
    } catch (const int code) {
        throw std::runtime_error(tetgen_reason(code));
    }
    if (out.numberoftetrahedra == 0) {
        throw std::runtime_error("TetGen: no tetrahedra");
    }
    std::vector<std::byte> bytes;
    const std::uint64_t counts[2]{static_cast<std::uint64_t>(out.numberofpoints),
                                  static_cast<std::uint64_t>(out.numberoftetrahedra)};
    put(bytes, counts, 2);
    put(bytes, out.pointlist, 3 * counts[0]);
    put(bytes, out.tetrahedronlist, 4 * counts[1]);
    return bytes;
}

/// TetGen may crash on a surface that intersects itself; its own check for that does not.
int count_intersecting(const Surface& boundary, double time_limit_s) {
    const ChildAnswer child = run_in_child(
        [&] {
            tetgenio in, out;
            fill_input(boundary, in);
            std::string switches = "pdQ";
            try {
                tetrahedralize(switches.data(), &in, &out);
            } catch (const int code) {
                throw std::runtime_error(tetgen_reason(code));
            }
            std::vector<std::byte> bytes;
            put(bytes, &out.numberoftrifaces, 1);
            return bytes;
        },
        time_limit_s);
    int count = 0;
    if (child.done && child.bytes.size() == sizeof count) {
        std::memcpy(&count, child.bytes.data(), sizeof count);
    }
    return count;
}

tissue::TetMesh unpack(const std::vector<std::byte>& bytes) {
    const std::byte* at = bytes.data();
    const auto take = [&](void* to, std::size_t size) {
        if (size > static_cast<std::size_t>(bytes.data() + bytes.size() - at)) {
            throw std::runtime_error("TetGen: the answer was cut short");
        }
        std::memcpy(to, at, size);
        at += size;
    };
    std::uint64_t counts[2];
    take(counts, sizeof counts);
    tissue::TetMesh mesh;
    for (std::uint64_t i = 0; i < counts[0]; ++i) {
        double p[3];
        take(p, sizeof p);
        mesh.rest_m.push_back(glm::dvec3{p[0], p[1], p[2]} / kScale);
    }
    for (std::uint64_t i = 0; i < counts[1]; ++i) {
        int corner[4];
        take(corner, sizeof corner);
        tissue::Tet tet{};
        for (int k = 0; k < 4; ++k) {
            tet[k] = static_cast<std::uint32_t>(corner[k]);
        }
        const auto& x = mesh.rest_m;
        const double six = glm::dot(glm::cross(x[tet[1]] - x[tet[0]], x[tet[2]] - x[tet[0]]),
                                    x[tet[3]] - x[tet[0]]);
        if (six < 0.0) { // TetGen orders its corners the other way round
            std::swap(tet[2], tet[3]);
        }
        mesh.tets.push_back(tet);
    }
    return mesh;
}

} // namespace

TetAnswer tetrahedralise(const Surface& boundary, const TetOptions& o) {
    // a regular tetrahedron of edge h has h^3 / (6 sqrt 2); real ones of that mean edge need room
    const double edge_mm = kScale * o.edge_m;
    const double volume_mm3 = 1.7 * edge_mm * edge_mm * edge_mm / (6.0 * std::sqrt(2.0));
    const auto with_quality = [&](double looser) {
        return fmt::format("pYQO9/7S{}q{:.3f}/{:.1f}a{:.3f}", kMaxAddedPoints,
                           1.0 + (o.quality_ratio - 1.0) * looser, o.quality_dihedral_deg / looser,
                           volume_mm3 * looser);
    };
    const std::vector<std::pair<std::string, std::string>> chain{
        {fmt::format("quality {}/{} degrees", o.quality_ratio, o.quality_dihedral_deg),
         with_quality(1.0)},
        {"half the quality, coarser", with_quality(2.0)},
        {"without quality", fmt::format("pYQS{}", kMaxAddedPoints)}};

    TetAnswer answer;
    for (const auto& [what, switches] : chain) {
        const ChildAnswer child = run_in_child(
            [&] { return run_tetgen(boundary, o.cavity_m, switches); }, o.time_limit_s);
        answer.attempts.push_back({what, child.done ? "done" : child.reason, child.seconds});
        if (child.done) {
            answer.mesh = unpack(child.bytes);
            return answer;
        }
    }
    const int intersecting = count_intersecting(boundary, o.time_limit_s);
    if (intersecting > 0) {
        answer.problem = fmt::format("{} triangles of the surface intersect others", intersecting);
    }
    return answer;
}

} // namespace bake

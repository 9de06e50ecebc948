#include "assets/bake/import/picture.h"

#include "assets/bake/import/box_tree.h"
#include "assets/bake/import/raster.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace bake {
namespace {

constexpr int kWidth = 3200, kHeight = 1600; // twice what is written
constexpr int kMargin = 120, kFoot = 150;
constexpr Colour kInk{0.13, 0.15, 0.19}, kPaper{0.965, 0.965, 0.955}, kGrey{0.45, 0.47, 0.5};
constexpr Colour kSkin{0.86, 0.56, 0.49}, kScenery{0.72, 0.7, 0.66}, kHeld{0.16, 0.36, 0.75};

/// From the front right and above, without perspective, into one half of the picture.
struct View {
    glm::dvec3 right, up, away, middle_m;
    double px_per_m = 1.0, centre_x = 0.0;

    [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& p_m) const {
        const glm::dvec3 d = (p_m - middle_m) * px_per_m;
        return {centre_x + glm::dot(d, right), 0.5 * (kHeight - kFoot) - glm::dot(d, up),
                glm::dot(d, away)};
    }
};

View make_view(const Imported& imported, double centre_x) {
    View v;
    v.away = glm::normalize(glm::dvec3{-0.45, 0.75, -0.5});
    v.right = glm::normalize(glm::cross(v.away, glm::dvec3{0, 0, 1}));
    v.up = glm::cross(v.right, v.away);
    double low_x = 1e9, high_x = -1e9, low_y = 1e9, high_y = -1e9;
    Box box;
    for (const auto& b : imported.bodies) {
        for (const auto& p : b.organ.surface.rest_m) {
            box.add(p);
            low_x = std::min(low_x, glm::dot(p, v.right));
            high_x = std::max(high_x, glm::dot(p, v.right));
            low_y = std::min(low_y, glm::dot(p, v.up));
            high_y = std::max(high_y, glm::dot(p, v.up));
        }
    }
    v.middle_m = 0.5 * (low_x + high_x) * v.right + 0.5 * (low_y + high_y) * v.up +
                 glm::dot(0.5 * (box.low + box.high), v.away) * v.away;
    v.px_per_m = std::min((0.5 * kWidth - 2 * kMargin) / (high_x - low_x),
                          (kHeight - kFoot - 2.0 * kMargin) / (high_y - low_y));
    v.centre_x = centre_x;
    return v;
}

void draw_triangle(Raster& raster, const View& view, const std::array<glm::dvec3, 3>& p_m,
                   const Colour& colour, double line) {
    const glm::dvec3 n = glm::normalize(glm::cross(p_m[1] - p_m[0], p_m[2] - p_m[0]));
    const glm::dvec3 lamp = glm::normalize(-view.away + 0.5 * view.up - 0.6 * view.right);
    const double light = 0.45 + 0.6 * std::max(0.0, glm::dot(n, lamp));
    raster.triangle({view(p_m[0]), view(p_m[1]), view(p_m[2])}, colour, std::min(light, 1.05),
                    line);
}

/// Red below 8 degrees, yellow at 25, green at 45 and above.
Colour quality_colour(double dihedral_deg) {
    const Colour red{0.8, 0.13, 0.15}, yellow{0.95, 0.83, 0.4}, green{0.22, 0.6, 0.45};
    const double t = std::clamp((dihedral_deg - 8.0) / 37.0, 0.0, 1.0);
    return t < 0.5 ? red + (yellow - red) * (2.0 * t) : yellow + (green - yellow) * (2.0 * t - 1.0);
}

/// Fixed, or in an elastic bed.
std::vector<char> held_nodes(const tissue::BakedOrgan& organ) {
    std::vector<char> held(organ.anchored.begin(), organ.anchored.end());
    for (const auto& sample : organ.bed) {
        for (const auto v : organ.mesh.tets[sample.tet]) {
            held[v] = 1;
        }
    }
    return held;
}

void draw_skin(Raster& raster, const View& view, const ImportedBody& body) {
    const auto& s = body.organ.surface;
    for (const auto& t : s.triangles) {
        draw_triangle(raster, view, {s.rest_m[t[0]], s.rest_m[t[1]], s.rest_m[t[2]]},
                      body.organ.rigid ? kScenery : kSkin, 0.25);
    }
    std::vector<char> outside(body.organ.mesh.rest_m.size(), 0);
    for (const auto& t : body.boundary.triangles) {
        for (const auto v : t) {
            outside[v] = 1;
        }
    }
    const auto held = held_nodes(body.organ);
    for (std::size_t v = 0; v < held.size(); ++v) {
        if (held[v] && outside[v]) {
            raster.dot(view(body.organ.mesh.rest_m[v]), 9.0, kHeld);
        }
    }
}

/// The half of the tetrahedra that lies away from the eye and to the left.
void draw_tets(Raster& raster, const View& view, const ImportedBody& body) {
    constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{
        {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
    const auto& mesh = body.organ.mesh;
    const glm::dvec3 cut = glm::normalize(-view.away + 0.9 * view.right);
    glm::dvec3 middle{0.0};
    for (const auto& p : mesh.rest_m) {
        middle += p / static_cast<double>(mesh.rest_m.size());
    }
    struct Face {
        std::array<std::uint32_t, 3> corner{};
        double dihedral_deg = 0.0;
        int count = 0;
    };
    std::map<std::array<std::uint32_t, 3>, Face> faces; // of the kept half; shown if there once
    for (const auto& t : mesh.tets) {
        const std::array<glm::dvec3, 4> c{mesh.rest_m[t[0]], mesh.rest_m[t[1]], mesh.rest_m[t[2]],
                                          mesh.rest_m[t[3]]};
        if (glm::dot(0.25 * (c[0] + c[1] + c[2] + c[3]) - middle, cut) > 0.0) {
            continue;
        }
        const auto angles = dihedrals_rad(c);
        const double deg =
            *std::min_element(angles.begin(), angles.end()) * 180.0 / std::numbers::pi;
        for (const auto& f : kFaces) {
            std::array<std::uint32_t, 3> corner{t[f[0]], t[f[1]], t[f[2]]}, key = corner;
            std::sort(key.begin(), key.end());
            Face& face = faces[key];
            face = {corner, deg, face.count + 1};
        }
    }
    for (const auto& [key, face] : faces) {
        if (face.count == 1) {
            draw_triangle(raster, view,
                          {mesh.rest_m[face.corner[0]], mesh.rest_m[face.corner[1]],
                           mesh.rest_m[face.corner[2]]},
                          quality_colour(face.dihedral_deg), 0.55);
        }
    }
}

void draw_key(Raster& raster, const Imported& imported) {
    std::size_t nodes = 0, tets = 0, triangles = 0;
    double worst_deg = 180.0;
    for (const auto& b : imported.bodies) {
        nodes += b.organ.mesh.rest_m.size();
        tets += b.organ.mesh.tets.size();
        triangles += b.organ.surface.triangles.size();
        worst_deg = std::min(worst_deg, b.quality.worst_dihedral_deg);
    }
    const int y = kHeight - kFoot + 40;
    raster.words(kMargin, y, fmt::format("SKIN  {} TRIANGLES", triangles), 7, kInk);
    if (tets == 0) {
        return;
    }
    const bool any_held =
        std::any_of(imported.bodies.begin(), imported.bodies.end(), [](const ImportedBody& b) {
            const auto held = held_nodes(b.organ);
            return std::find(held.begin(), held.end(), 1) != held.end();
        });
    if (any_held) {
        raster.box(kMargin, y + 62, 22, 22, kHeld);
    }
    raster.words(kMargin + (any_held ? 40 : 0), y + 60, any_held ? "HELD" : "HELD NOWHERE", 5,
                 kGrey);
    const int x = kWidth / 2 + kMargin;
    raster.words(x, y,
                 fmt::format("{} NODES  {} TETRAHEDRA  WORST {:.1f} DEG", nodes, tets, worst_deg),
                 7, kInk);
    constexpr int kBar = 600;
    for (int i = 0; i < kBar; ++i) {
        raster.box(x + i, y + 62, 1, 24, quality_colour(8.0 + 37.0 * i / kBar));
    }
    raster.words(x + kBar + 20, y + 60, "SMALLEST DIHEDRAL 8 TO 45 DEG", 5, kGrey);
}

} // namespace

std::string picture_png(const Imported& imported) {
    Raster raster(kWidth, kHeight, kPaper);
    const bool solid = std::any_of(imported.bodies.begin(), imported.bodies.end(),
                                   [](const ImportedBody& b) { return !b.organ.rigid; });
    const View left = make_view(imported, (solid ? 0.25 : 0.5) * kWidth);
    const View right = make_view(imported, 0.75 * kWidth);
    for (const auto& body : imported.bodies) {
        draw_skin(raster, left, body);
        if (!body.organ.rigid) {
            draw_tets(raster, right, body);
        }
    }
    draw_key(raster, imported);
    return raster.png();
}

} // namespace bake

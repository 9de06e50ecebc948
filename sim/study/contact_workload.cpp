#include "sim/study/contact_workload.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <stdexcept>

namespace sim {
namespace {

using glm::dvec3;
using haptics::Corners;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kBreath_hz = 1.0;
constexpr double kWaveLength_m = 0.060;
constexpr std::uint64_t kNoiseStream = 0x6e6f697365u, kPathStream = 0x70617468u;

// --- names

[[noreturn]] void refuse(const std::string& name) {
    throw std::invalid_argument("mesh '" + name +
                                "': accepted: organ:COUNT or sheet:COUNT, COUNT from 100 to 10M "
                                "triangles, such as organ:10k or sheet:1M");
}

double count_of(const std::string& name) {
    double count = 0.0;
    const char* const first = name.data() + name.find(':') + 1;
    const char* const end = name.data() + name.size();
    auto [rest, error] = std::from_chars(first, end, count, std::chars_format::fixed);
    if (error != std::errc{})
        refuse(name);
    if (rest != end && (*rest == 'k' || *rest == 'M'))
        count *= *rest++ == 'k' ? 1e3 : 1e6;
    if (rest != end || !(count >= 100.0 && count <= 1e7))
        refuse(name);
    return count;
}

// --- meshes

void make_organ(ContactWorkload& work) {
    const Geodesic& sphere = work.organ.emplace(work.cells);
    const double area_m2 = 4.0 * std::numbers::pi * kOrganRadius_m * kOrganRadius_m;
    const double edge_m = std::sqrt(area_m2 / (20.0 * work.cells * work.cells) * 4.0 /
                                    std::numbers::sqrt3); // of even triangles
    Dice dice(work.seed ^ kNoiseStream);
    work.rest_m = sphere.directions();
    for (dvec3& v : work.rest_m)
        v = organ_skin(work.ripples, v).place_m + kFineNoise * edge_m * dice.between(-1.0, 1.0) * v;
    work.triangle = sphere.triangles();
}

double sheet_x_m(int cells, int i) noexcept {
    return kSheetWidth_m * (static_cast<double>(i) / cells - 0.5);
}

std::uint32_t sheet_vertex(int cells, int i, int j) noexcept {
    return static_cast<std::uint32_t>(j * (cells + 1) + i);
}

/// Of the upper skin, counter-clockwise from above; the diagonal rises in x and y.
Corners sheet_corners(int cells, int i, int j, bool right) noexcept {
    const auto at = [&](int x, int y) { return sheet_vertex(cells, i + x, j + y); };
    return right ? Corners{at(0, 0), at(1, 0), at(1, 1)} : Corners{at(0, 0), at(1, 1), at(0, 1)};
}

void add_rim(const std::vector<std::uint32_t>& around, std::uint32_t below,
             std::vector<Corners>& triangle) {
    for (std::size_t i = 0; i < around.size(); ++i) {
        const std::uint32_t a = around[i], b = around[(i + 1) % around.size()];
        triangle.push_back({b, a, a + below});
        triangle.push_back({b, a + below, b + below});
    }
}

void make_sheet(ContactWorkload& work) {
    const int n = work.cells;
    const double edge_m = kSheetWidth_m / n;
    Dice dice(work.seed ^ kNoiseStream);
    std::vector<dvec3> under;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const SkinPlace skin = sheet_skin(work.ripples, sheet_x_m(n, i), sheet_x_m(n, j));
            const dvec3 noise{0.0, 0.0, kFineNoise * edge_m * dice.between(-1.0, 1.0)};
            work.rest_m.push_back(skin.place_m + noise);
            under.push_back(skin.place_m + noise -
                            dvec3{0.0, 0.0, kSheetThickness_m / skin.normal.z});
        }
    const auto below = static_cast<std::uint32_t>(under.size());
    work.rest_m.insert(work.rest_m.end(), under.begin(), under.end());
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            for (const bool right : {true, false}) {
                const auto [a, b, c] = sheet_corners(n, i, j, right);
                work.triangle.push_back({a, b, c});
                work.triangle.push_back({a + below, c + below, b + below});
            }
    std::vector<std::uint32_t> around; // counter-clockwise from above
    for (int i = 0; i < n; ++i)
        around.push_back(sheet_vertex(n, i, 0));
    for (int j = 0; j < n; ++j)
        around.push_back(sheet_vertex(n, n, j));
    for (int i = n; i > 0; --i)
        around.push_back(sheet_vertex(n, i, n));
    for (int j = n; j > 0; --j)
        around.push_back(sheet_vertex(n, 0, j));
    add_rim(around, below, work.triangle);
}

/// How far along the line origin + s direction the plane of the triangle is.
double plane_along(std::span<const dvec3> vertex_m, const Corners& t, std::uint32_t shift,
                   const dvec3& origin_m, const dvec3& direction) noexcept {
    const dvec3 a = vertex_m[t[0] + shift], b = vertex_m[t[1] + shift], c = vertex_m[t[2] + shift];
    const dvec3 normal = glm::cross(b - a, c - a);
    return glm::dot(normal, a - origin_m) / glm::dot(normal, direction);
}

} // namespace

bool is_contact_workload(const std::string& name) {
    return name.starts_with("organ:") || name.starts_with("sheet:");
}

ContactWorkload make_contact_workload(const std::string& name, std::uint64_t seed) {
    if (!is_contact_workload(name))
        refuse(name);
    const double count = count_of(name);
    ContactWorkload work;
    work.name = name;
    work.seed = seed;
    if (name.starts_with("organ:")) {
        work.cells = static_cast<int>(std::lround(std::sqrt(count / 20.0)));
        work.ripples = organ_ripples(seed);
        make_organ(work);
    } else {
        work.cells = static_cast<int>(std::lround(std::sqrt(1.0 + count / 4.0) - 1.0));
        work.ripples = sheet_ripples(seed);
        make_sheet(work);
    }
    return work;
}

Wave wave_of(const std::string& name) {
    if (name == "radial")
        return Wave::radial;
    if (name == "travelling")
        return Wave::travelling;
    throw std::invalid_argument("wave '" + name + "': accepted: radial, travelling");
}

haptics::MeshView MovingSkin::view(const ContactWorkload& work) const noexcept {
    haptics::MeshView mesh{.vertex_m = now_m, .triangle = work.triangle, .before_m = {}};
    if (moved)
        mesh.before_m = before_m;
    return mesh;
}

void follow(const ContactWorkload& work, const Breathing& breathing, int tick, MovingSkin& skin) {
    const auto frame_of = [](int t) { return t * kMeshHz / kTickHz; };
    const bool breathes = breathing.amplitude_m != 0.0;
    skin.moved = breathes && tick > 0 && frame_of(tick) != frame_of(tick - 1);
    if (tick > 0 && !skin.moved)
        return;
    std::swap(skin.now_m, skin.before_m);
    skin.now_m.resize(work.rest_m.size());
    const double turn = kTurn * kBreath_hz * frame_of(tick) / kMeshHz;
    const double wave = breathing.wave == Wave::travelling ? kTurn / kWaveLength_m : 0.0;
    for (std::size_t v = 0; v < work.rest_m.size(); ++v) {
        const dvec3& rest = work.rest_m[v];
        const dvec3 along = work.organ ? glm::normalize(rest) : dvec3{0.0, 0.0, 1.0};
        skin.now_m[v] = rest + breathing.amplitude_m * std::sin(turn - wave * rest.x) * along;
    }
}

int side_of(const ContactWorkload& work, std::span<const dvec3> vertex_m,
            const dvec3& place_m) noexcept {
    if (work.organ) {
        const double radius = glm::length(place_m);
        if (!(radius > 0.0))
            return 0;
        const Corners t = work.organ->corners_at(place_m);
        return radius > plane_along(vertex_m, t, 0, dvec3{0.0}, place_m / radius) ? 1 : 0;
    }
    const int n = work.cells;
    const double x = std::clamp((place_m.x / kSheetWidth_m + 0.5) * n, 0.0, 1.0 * n);
    const double y = std::clamp((place_m.y / kSheetWidth_m + 0.5) * n, 0.0, 1.0 * n);
    const int i = std::min(static_cast<int>(x), n - 1), j = std::min(static_cast<int>(y), n - 1);
    const Corners t = sheet_corners(n, i, j, x - i >= y - j);
    const dvec3 foot{kSheetWidth_m * (x / n - 0.5), kSheetWidth_m * (y / n - 0.5), 0.0};
    const dvec3 up{0.0, 0.0, 1.0};
    if (place_m.z > plane_along(vertex_m, t, 0, foot, up))
        return 1;
    const auto below = static_cast<std::uint32_t>((n + 1) * (n + 1));
    return place_m.z < plane_along(vertex_m, t, below, foot, up) ? -1 : 0;
}

std::vector<dvec3> contact_path(const ContactWorkload& work, double seconds, std::uint64_t seed,
                                double radius_m) {
    if (!(radius_m >= 0.0) || !(seconds > 0.0 && seconds <= 3600.0))
        throw std::invalid_argument("contact path: radius must be >= 0, seconds 0 to 3600");
    constexpr double kMean_m = 0.0014, kSwing_m = 0.0024, kTremble_m = 0.0002; // depth -1..3.8
    constexpr double kHop_m = 0.020, kHopEvery_s = 2.0, kHopLasts_s = 0.3;
    Dice dice(seed ^ kPathStream);
    std::array<double, 4> phase{};
    for (double& p : phase)
        p = dice.between(0.0, kTurn);
    std::vector<dvec3> path(static_cast<std::size_t>(std::lround(seconds * kTickHz)));
    for (std::size_t tick = 0; tick < path.size(); ++tick) {
        const double t = static_cast<double>(tick) / kTickHz;
        const double a = std::sin(kTurn * 0.23 * t + phase[0]);
        const double b = std::sin(kTurn * 0.31 * t + phase[1]);
        const double depth_m = kMean_m - kSwing_m * std::cos(kTurn * 0.7 * t + phase[2]);
        const double hop = std::abs(std::remainder(t, kHopEvery_s)) / (0.5 * kHopLasts_s);
        const double hop_m =
            hop < 1.0 ? 0.5 * kHop_m * (1.0 + std::cos(std::numbers::pi * hop)) : 0.0;
        const double tremble = kTurn * 8.0 * t + phase[3];
        const SkinPlace skin =
            work.organ ? organ_skin(work.ripples,
                                    {std::cos(0.9 * a) * std::cos(0.7 * b),
                                     std::sin(0.9 * a) * std::cos(0.7 * b), std::sin(0.7 * b)})
                       : sheet_skin(work.ripples, 0.042 * a, 0.042 * b);
        const dvec3 across =
            glm::normalize(glm::cross(skin.normal, work.organ ? dvec3{0, 0, 1} : dvec3{1, 0, 0}));
        path[tick] = skin.place_m +
                     (radius_m - depth_m + hop_m + kTremble_m * std::sin(tremble)) * skin.normal +
                     kTremble_m * std::cos(tremble) * across;
    }
    return path;
}

} // namespace sim

// sim/study/rigid_cluster_failures.cpp
// A flat face sampled by many points: its stiffness without and with clusters of contacts.
#include "haptics/rigid/contact_clusters.h"
#include "haptics/rigid/voxel_contacts.h"
#include "sim/study/rigid_failures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <glm/geometric.hpp>

namespace sim {
namespace {

using glm::dvec3;
using haptics::ContactPatch;
using haptics::Wrench;

constexpr double kSide_m = 20e-3, kPoint_npm = 300.0;
constexpr double kMass_kg = 0.1, kDamping_nspm = 0.5, kTick_s = 1e-3;
constexpr std::array<int, 4> kPointsPerSide{1, 2, 4, 8};

/// The face's middle is `depth_m` below the plane z = 0, tilted about y by `tilt_rad`.
struct Face {
    double depth_m, tilt_rad;

    dvec3 place(double x_m, double y_m) const {
        return {x_m * std::cos(tilt_rad), y_m, -x_m * std::sin(tilt_rad) - depth_m};
    }
};

/// Wrench about the face's middle when it is sampled by n x n points.
using Method = std::function<Wrench(const Face&, int)>;

void each_point(const Face& face, int n, const std::function<void(const dvec3&)>& use) {
    for (int i = 0; i < n * n; ++i)
        use(face.place(((i % n + 0.5) / n - 0.5) * kSide_m, ((i / n + 0.5) / n - 0.5) * kSide_m));
}

Wrench spring_at(const dvec3& place_m, double depth_m, const Face& face) {
    const dvec3 force_n{0, 0, kPoint_npm * depth_m};
    return {force_n, glm::cross(place_m - dvec3{0, 0, -face.depth_m}, force_n)};
}

Wrench sum(const Face& face, int n) {
    Wrench all;
    each_point(face, n, [&](const dvec3& p) {
        const Wrench one = spring_at(p, std::max(0.0, -p.z), face);
        all.force_n += one.force_n;
        all.torque_nm += one.torque_nm;
    });
    return all;
}

Wrench count_mean(const Face& face, int n) {
    dvec3 place{0.0};
    double depth_m = 0.0;
    int touching = 0;
    each_point(face, n, [&](const dvec3& p) {
        if (p.z < 0.0) {
            place += p;
            depth_m -= p.z;
            ++touching;
        }
    });
    return touching ? spring_at(place / double(touching), depth_m / touching, face) : Wrench{};
}

Wrench clusters(const Face& face, int n) {
    const dvec3 up{0, 0, 1};
    const dvec3 normal{std::sin(face.tilt_rad), 0, std::cos(face.tilt_rad)};
    std::vector<ContactPatch> patch;
    for (int i = 0; i < n * n; ++i) {
        const auto at = [&](int dx, int dy) {
            return face.place((double(i % n + dx) / n - 0.5) * kSide_m,
                              (double(i / n + dy) / n - 0.5) * kSide_m);
        };
        const std::array corner{at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
        patch.push_back(
            haptics::part_in_contact(corner, up, -corner[0].z, glm::dot(normal, up) * normal - up));
    }
    haptics::ContactList contacts;
    haptics::cluster_contacts(patch, {}, contacts);
    return haptics::contact_wrench(contacts, kPoint_npm, {0, 0, -face.depth_m});
}

// A block of 40 x 40 x 40 mm below z = 0, and a plate as thin as the face's shell needs.
haptics::RigidSurface block(const char* name, const dvec3& low, const dvec3& high) {
    std::vector<dvec3> vertex;
    for (int i = 0; i < 8; ++i)
        vertex.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
    const std::vector<std::array<std::uint32_t, 3>> triangle{
        {0, 2, 3}, {3, 1, 0}, {4, 5, 7}, {7, 6, 4}, {0, 1, 5}, {5, 4, 0},
        {2, 6, 7}, {7, 3, 2}, {0, 4, 6}, {6, 2, 0}, {1, 3, 7}, {7, 5, 1}};
    return haptics::make_surface(name, vertex, triangle);
}

struct Voxels {
    haptics::VoxelMap map =
        haptics::make_voxel_map(block("block", {-0.02, -0.02, -0.04}, {0.02, 0.02, 0}), 1e-3);
    std::array<haptics::PointShell, 4> shell;

    Voxels() {
        const double half = 0.5 * kSide_m;
        const auto tool = block("tool", {-half, -half, 0}, {half, half, kSide_m});
        for (std::size_t i = 0; i < shell.size(); ++i) // diagonals of the cells
            shell[i] = haptics::make_point_shell(tool, 1.5 * kSide_m / kPointsPerSide[i]);
    }

    std::vector<ContactPatch> patches(const Face& face, int n, haptics::ContactList& out) const {
        const auto which = std::find(kPointsPerSide.begin(), kPointsPerSide.end(), n);
        const auto& points = shell[static_cast<std::size_t>(which - kPointsPerSide.begin())];
        const double c = std::cos(face.tilt_rad), s = std::sin(face.tilt_rad);
        auto scratch = haptics::reserve_for(points);
        haptics::voxel_contacts(map, {}, points,
                                {glm::dmat3{c, 0, -s, 0, 1, 0, s, 0, c}, {0, 0, -face.depth_m}}, {},
                                scratch, out);
        return scratch.patch;
    }
    Wrench area(const Face& face, int n) const {
        haptics::ContactList contacts;
        patches(face, n, contacts);
        return haptics::contact_wrench(contacts, kPoint_npm, {0, 0, -face.depth_m});
    }
    Wrench springs(const Face& face, int n) const {
        haptics::ContactList contacts;
        Wrench all;
        for (const ContactPatch& p : patches(face, n, contacts)) {
            if (p.area_m2 <
                0.25 * kSide_m * kSide_m / (n * n)) // of the sides: half a cell is whole
                continue;
            const Wrench one = spring_at(p.middle_m, p.depth_m, face);
            all.force_n += one.force_n;
            all.torque_nm += one.torque_nm;
        }
        return all;
    }
};

/// Largest eigenvalue of m x'' + b x' = -K x_k with the force held for a tick.
double spectral_radius(double stiffness_npm) {
    const double rate = kDamping_nspm / kMass_kg, decay = std::exp(-rate * kTick_s);
    const double moves_s = (1.0 - decay) / rate;
    const double x = (kTick_s - moves_s) / kDamping_nspm, v = (1.0 - decay) / kDamping_nspm;
    const double trace = 1.0 - stiffness_npm * x + decay;
    const double det = (1.0 - stiffness_npm * x) * decay + stiffness_npm * v * moves_s;
    const std::complex<double> root = std::sqrt(std::complex<double>(trace * trace - 4.0 * det));
    return 0.5 * std::max(std::abs(trace + root), std::abs(trace - root));
}

double push_npm(const Method& method, int n) {
    const double step_m = 1e-6, at_m = 0.5e-3;
    return (method({at_m + step_m, 0}, n).force_n.z - method({at_m, 0}, n).force_n.z) / step_m;
}

double tilt_nmprad(const Method& method, int n) {
    const double step = 1e-4, at_m = 0.5e-3;
    return -(method({at_m, step}, n).torque_nm.y - method({at_m, -step}, n).torque_nm.y) /
           (2.0 * step);
}

/// The number of points for which a stiffness is farthest off decides.
double off_percent(const Method& method, double (*stiffness)(const Method&, int), double right) {
    double most = 0.0;
    for (const int n : kPointsPerSide)
        most = std::max(most, 100.0 * std::abs(stiffness(method, n) / right - 1.0));
    return most;
}

/// Largest change of the torque over k dz side, as a face tilted by 1 degree goes in.
double torque_jump(const Method& method, int n) {
    const double step_m = 1e-6;
    double most = 0.0, last_nm = 0.0;
    for (double depth_m = -0.2e-3; depth_m < 0.2e-3; depth_m += step_m) {
        const double torque_nm = method({depth_m, 0.0174533}, n).torque_nm.y;
        most = std::max(most, std::abs(torque_nm - last_nm));
        last_nm = torque_nm;
    }
    return most / (kPoint_npm * step_m * kSide_m);
}

} // namespace

std::vector<RigidFailureRow> rigid_cluster_failures() {
    const Voxels voxels;
    struct Named {
        const char* name;
        Method method;
        bool rings, uneven, jumps; // what it is known for
    };
    const std::array<Named, 5> methods{
        Named{"sum", sum, true, true, true}, Named{"count-mean", count_mean, false, true, true},
        Named{"voxel-springs", [&](const Face& f, int n) { return voxels.springs(f, n); }, true,
              true, true},
        Named{"voxel-area", [&](const Face& f, int n) { return voxels.area(f, n); }, false, false,
              false},
        Named{"clusters", clusters, false, false, false}};
    std::vector<RigidFailureRow> rows;
    const auto add = [&](const char* method, const std::string& quantity, double value,
                         double bound, bool fails) {
        rows.push_back({"F16 flat face", method, quantity, value, bound, fails, value <= bound});
    };
    for (const Named& m : methods) {
        for (const int n : kPointsPerSide)
            add(m.name, "spectral radius, " + std::to_string(n * n) + " points",
                spectral_radius(push_npm(m.method, n)), 1.0, m.rings && n > 1);
        add(m.name, "push stiffness off k, %", off_percent(m.method, push_npm, kPoint_npm), 5.0,
            m.rings);
        add(m.name, "tilt stiffness off k side^2 / 12, %",
            off_percent(m.method, tilt_nmprad, kPoint_npm * kSide_m * kSide_m / 12.0), 5.0,
            m.uneven);
        add(m.name, "torque step over k dz side, 64 points", torque_jump(m.method, 8), 2.0,
            m.jumps);
    }
    return rows;
}

std::vector<RigidFailureRow> run_rigid_failures() {
    std::vector<RigidFailureRow> rows = rigid_cluster_failures();
    for (RigidFailureRow& row : rigid_depth_failures())
        rows.push_back(std::move(row));
    return rows;
}

} // namespace sim

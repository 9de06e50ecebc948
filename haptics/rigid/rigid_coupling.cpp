#include "haptics/rigid/rigid_coupling.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <tuple>

namespace haptics {
namespace {

using glm::dvec3;
using Row6 = std::array<double, 6>;

constexpr int kMostRounds = 8;

// How the depth of a contact grows with the motion of a body that is pushed along `way`.
Row6 deepens(const dvec3& way, const dvec3& arm_m) noexcept {
    const dvec3 moment = glm::cross(arm_m, way);
    return {-way.x, -way.y, -way.z, -moment.x, -moment.y, -moment.z};
}

// Covariance of x cross n over the area: tilt stiffness of the contact about its own middle.
glm::dmat3 tilt_of(const RepresentativeContact& c) noexcept {
    const dvec3& n = c.normal;
    const glm::dmat3 cross_n{0.0, -n.z, n.y, n.z, 0.0, -n.x, -n.y, n.x, 0.0}; // x -> x cross n
    return cross_n * c.spread_m2 * glm::transpose(cross_n);
}

struct Entry {
    std::uint32_t tool;
    Row6 row;
    double sign; // of the tilt against the other body
};

// The contact's bodies that can move: none, one or two.
Bounded<Entry, 2> entries(const ToolContact& c, std::span<const CoupledTool> tool) noexcept {
    Bounded<Entry, 2> list;
    const auto add = [&](std::uint32_t t, double sign) {
        if (t < tool.size())
            list.add({t,
                      deepens(sign * c.contact.normal, c.contact.place_m - tool[t].tool.position_m),
                      sign});
    };
    add(c.second, 1.0);
    add(c.first, -1.0);
    return list;
}

void add_contact(SpdSystem& system, const ToolContact& c, std::span<const CoupledTool> tool,
                 double stiffness_npm) noexcept {
    const double k = stiffness_npm * c.contact.share;
    const glm::dmat3 tilt = tilt_of(c.contact);
    const auto list = entries(c, tool);
    for (const Entry& p : list) {
        for (std::size_t i = 0; i < 6; ++i)
            system.b[6 * p.tool + i] -= k * c.contact.depth_m * p.row[i];
        for (const Entry& q : list) {
            for (std::size_t i = 0; i < 6; ++i)
                for (std::size_t j = 0; j < 6; ++j)
                    system.a[6 * p.tool + i][6 * q.tool + j] += k * p.row[i] * q.row[j];
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    system.a[6 * p.tool + 3 + i][6 * q.tool + 3 + j] +=
                        k * p.sign * q.sign * tilt[j][i];
        }
    }
}

double depth_after(const ToolContact& c, std::span<const CoupledTool> tool,
                   const std::array<double, SpdSystem::kMost>& motion) noexcept {
    double depth_m = c.contact.depth_m;
    for (const Entry& e : entries(c, tool))
        for (std::size_t i = 0; i < 6; ++i)
            depth_m += e.row[i] * motion[6 * e.tool + i];
    return depth_m;
}

void add_springs(SpdSystem& system, std::span<const CoupledTool> tool) noexcept {
    system.n = 6 * tool.size();
    for (std::size_t t = 0; t < tool.size(); ++t) {
        const dvec3 move_m = tool[t].device.position_m - tool[t].tool.position_m;
        const dvec3 turn = turn_between(tool[t].tool.rotation, tool[t].device.rotation);
        for (int i = 0; i < 3; ++i) {
            system.a[6 * t + i][6 * t + i] = tool[t].spring.stiffness_npm;
            system.b[6 * t + i] = tool[t].spring.stiffness_npm * move_m[i];
            system.a[6 * t + 3 + i][6 * t + 3 + i] = tool[t].spring.torsion_nmprad;
            system.b[6 * t + 3 + i] = tool[t].spring.torsion_nmprad * turn[i];
        }
    }
}

dvec3 limited(const dvec3& v, double most) noexcept {
    const double length = glm::length(v);
    return length > most ? v * (most / length) : v;
}

void move(RigidPose& pose, const dvec3& by_m, const dvec3& turn) noexcept {
    pose.position_m += by_m;
    const double angle = glm::length(turn);
    if (angle > 0.0)
        pose.rotation = glm::mat3_cast(
            glm::normalize(glm::angleAxis(angle, turn / angle) * glm::quat_cast(pose.rotation)));
}

void feel(CoupledTool& t) noexcept {
    t.wrench.force_n = t.spring.stiffness_npm * (t.tool.position_m - t.device.position_m);
    t.wrench.torque_nm = t.spring.torsion_nmprad * turn_between(t.device.rotation, t.tool.rotation);
}

// K - K (K + G)^-1 K, K the spring and G the contacts, the other tools held.
void set_felt(CoupledTool& t, const Matrix6& contacts) noexcept {
    for (std::size_t j = 0; j < 6; ++j) {
        SpdSystem system;
        system.n = 6;
        for (std::size_t i = 0; i < 6; ++i) {
            for (std::size_t k = 0; k < 6; ++k)
                system.a[i][k] = contacts[i][k];
            system.a[i][i] += i < 3 ? t.spring.stiffness_npm : t.spring.torsion_nmprad;
            system.b[i] = contacts[i][j]; // column of (K + G)^-1 G, to be multiplied by K
        }
        if (!solve(system))
            return;
        for (std::size_t i = 0; i < 6; ++i)
            t.felt[i][j] = system.b[i] * (i < 3 ? t.spring.stiffness_npm : t.spring.torsion_nmprad);
    }
}

} // namespace

dvec3 turn_between(const glm::dmat3& from, const glm::dmat3& to) noexcept {
    glm::dquat q = glm::quat_cast(to * glm::transpose(from));
    if (q.w < 0.0)
        q = -q;
    const dvec3 v{q.x, q.y, q.z};
    const double s = glm::length(v);
    return s > 0.0 ? v * (2.0 * std::atan2(s, q.w) / s) : dvec3{0.0};
}

CouplingSpring safe_spring(const DeviceDamping& device, double share) noexcept {
    return {share * 2.0 * device.force_nspm / device.tick_s,
            share * 2.0 * device.torque_nmsprad / device.tick_s};
}

double passivity_share(const Matrix6& stiffness, const DeviceDamping& device) noexcept {
    Matrix6 m = stiffness;
    const auto root = [&](std::size_t i) {
        return std::sqrt(i < 3 ? device.force_nspm : device.torque_nmsprad);
    };
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j)
            m[i][j] *= 0.5 * device.tick_s / (root(i) * root(j));
    return largest_eigenvalue(m);
}

void add_stiffness(Matrix6& stiffness, const RepresentativeContact& contact, double stiffness_npm,
                   const dvec3& about_m) noexcept {
    const double k = stiffness_npm * contact.share;
    const Row6 row = deepens(contact.normal, contact.place_m - about_m);
    const glm::dmat3 tilt = tilt_of(contact);
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j)
            stiffness[i][j] += k * row[i] * row[j];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            stiffness[3 + i][3 + j] += k * tilt[j][i];
}

bool balance(std::span<CoupledTool> tool, std::span<const ToolContact> contact,
             double stiffness_npm) noexcept {
    tool = tool.first(std::min<std::size_t>(tool.size(), kMostRigidTools));
    std::array<bool, std::tuple_size_v<decltype(ToolContactList::item)>> pulls{};
    contact = contact.first(std::min(contact.size(), pulls.size()));
    SpdSystem system;
    bool again = true;
    for (int round = 0; again && round < kMostRounds; ++round) {
        system = {};
        add_springs(system, tool);
        for (std::size_t i = 0; i < contact.size(); ++i)
            if (!pulls[i])
                add_contact(system, contact[i], tool, stiffness_npm);
        if (!solve(system)) {
            for (CoupledTool& t : tool)
                t.wrench = {};
            return false;
        }
        again = false;
        for (std::size_t i = 0; i < contact.size(); ++i) {
            if (!pulls[i] && depth_after(contact[i], tool, system.b) < 0.0)
                pulls[i] = again = true;
        }
    }
    for (std::uint32_t t = 0; t < tool.size(); ++t) {
        Matrix6 contacts{};
        for (std::size_t i = 0; i < contact.size(); ++i)
            if (!pulls[i] && (contact[i].first == t || contact[i].second == t))
                add_stiffness(contacts, contact[i].contact, stiffness_npm, tool[t].tool.position_m);
        set_felt(tool[t], contacts);
        const double* m = &system.b[6 * t];
        move(tool[t].tool, limited({m[0], m[1], m[2]}, tool[t].most_step_m),
             limited({m[3], m[4], m[5]}, tool[t].most_turn_rad));
        feel(tool[t]);
    }
    return true;
}

} // namespace haptics

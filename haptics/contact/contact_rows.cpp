#include "haptics/contact/contact_rows.h"

#include "haptics/contact/coulomb_disc.h"
#include "haptics/contact/grasp.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace haptics {
namespace {

constexpr double kTolerance_m = 1e-12;

glm::dvec3 tangential(const glm::dvec3& v, const glm::dvec3& n) noexcept {
    return v - n * glm::dot(n, v);
}

// Columns t1, t2, n, right-handed (Duff et al. 2017, "Building an orthonormal basis, revisited").
glm::dmat3 contact_frame(const glm::dvec3& n) noexcept {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1.0 / (sign + n.z);
    const double b = n.x * n.y * a;
    return {
        {1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

// Root x >= 0 of  W_nn P(x) + depth(x) = reach: Newton, kept inside a bracket by bisection.
// The left side grows with x. NaN if it cannot reach that far (nothing yields at all).
double normal_root(const LocalLaw& law, double w_nn, double reach_m, double warm_x) noexcept {
    const auto excess = [&](double x) {
        const LawPoint p = law_at(law, x);
        return std::array{w_nn * p.force_n + p.depth_m - reach_m, w_nn * p.dforce_dx + p.ddepth_dx};
    };
    if (reach_m <= 0.0)
        return 0.0;

    // the law is at least as steep as its floor, which bounds the force and so the root
    const double force_max = reach_m / (w_nn + law.floor_mpn);
    double low = 0.0;
    double high = law.table ? std::cbrt(force_max / law.table->force_scale_n) : force_max;
    if (!(high > 0.0 && high < 1e100))
        high = law.table ? law.table->x_step : 1.0;
    high *= 1.0 + 1e-12;
    for (int i = 0; i < 200 && !(excess(high)[0] >= 0.0); ++i)
        high *= 2.0;
    if (!(excess(high)[0] >= 0.0))
        return std::numeric_limits<double>::quiet_NaN();

    double x = warm_x > low && warm_x < high ? warm_x : high;
    for (int i = 0; i < 100; ++i) {
        const auto [value, slope] = excess(x);
        if (std::abs(value) <= 1e-4 * kTolerance_m)
            break;
        (value > 0.0 ? high : low) = x;
        const double newton = x - value / slope;
        const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
        if (next == x)
            break;
        x = next;
    }
    return x;
}

// One contact in its own frame (t1, t2, n), as the sweeps need it.
struct Contact {
    glm::dmat3 frame{1.0};
    glm::dvec3 offset_m{0.0}; // p - y_free
    glm::dvec3 before_n{0.0}; // friction carried over
    glm::dvec3 lag_m{0.0};    // lag carried over
    double stand_m = 0.0; // height of the tip over the skin at which it neither presses nor pulls
    glm::dvec3 others_m{0.0}; // what the other tools push here
    glm::dvec3 force_n{0.0};
    double x = 0.0;
    double multiplier = 0.0;
    bool grasped = false;
    GraspCompliance held{};
};

Contact make_contact(const ContactRow& row, const ContactMemory& memory) noexcept {
    Contact c;
    c.frame = contact_frame(row.normal);
    c.offset_m = (row.tip_m - row.surface_free_m) * c.frame; // v * M = M^T v
    c.x = memory.touching ? memory.x : 0.0;
    c.stand_m = row.tip_radius_m;
    if (memory.grasped) {
        c.grasped = true;
        c.held = grasp_compliance(row.law);
        c.lag_m = memory.grip_m * c.frame;
        c.stand_m = c.lag_m.z;
        c.lag_m.z = 0.0;
        return c;
    }
    if (row.friction > 0.0 && memory.touching) {
        c.before_n = tangential(memory.friction_n, row.normal) * c.frame;
        c.lag_m = tangential(memory.lag_m, row.normal) * c.frame;
    } else if (row.friction > 0.0) {
        // a tip over a facet is not quite over its point along the smooth normal: no reason to pull
        c.lag_m = c.offset_m;
    }
    c.before_n.z = c.lag_m.z = 0.0;
    return c;
}

glm::dmat2 tangent_block(const glm::dmat3& own, double compliance_mpn) noexcept {
    return {own[0][0] + compliance_mpn, own[0][1], own[1][0], own[1][1] + compliance_mpn};
}

// Right-hand side of the stick equation  (W_tt + C_t) F_t = C_t F_before + lag - (p - y_free)_t ...
glm::dvec2 stick_side(const Contact& c, const glm::dmat3& own, double compliance_mpn,
                      double normal_n) noexcept {
    return compliance_mpn * glm::dvec2{c.before_n} + glm::dvec2{c.lag_m - c.offset_m - c.others_m} -
           glm::dvec2{own[2]} * normal_n;
}

double tangential_of(const ContactRow& row, const Contact& c) noexcept {
    return c.grasped ? c.held.tangential_mpn : tangential_compliance(row.law, c.x);
}

// What the force across the normal may reach.
double tangential_limit(const ContactRow& row, const Contact& c) noexcept {
    return c.grasped ? row.hold_n : row.friction * c.force_n.z;
}

// A grasp in tension: all three rows at once.
void solve_pull(const ContactRow& row, const glm::dmat3& own, Contact& c) noexcept {
    glm::dmat3 A = own;
    A[0][0] += c.held.tangential_mpn;
    A[1][1] += c.held.tangential_mpn;
    A[2][2] += c.held.normal_mpn;
    const glm::dvec3 grip_m{c.lag_m.x, c.lag_m.y, c.stand_m};
    const PullPoint pull = pull_minimum(A, grip_m - c.offset_m - c.others_m, row.hold_n);
    c.force_n = pull.f;
    c.multiplier = pull.multiplier;
    c.x = 0.0;
}

// Normal law, then Coulomb disc, each exact for what the other and the other tools do now.
void solve_block(const ContactRow& row, const glm::dmat3& own, Contact& c) noexcept {
    const double reach_m =
        c.stand_m - c.offset_m.z - c.others_m.z - own[0][2] * c.force_n.x - own[1][2] * c.force_n.y;
    if (c.grasped && !(reach_m > 0.0))
        return solve_pull(row, own, c);
    c.x = normal_root(row.law, own[2][2], reach_m, c.x);
    c.force_n.z = law_at(row.law, c.x).force_n;

    const double soft = tangential_of(row, c);
    const DiscPoint stick = disc_minimum(
        tangent_block(own, soft), stick_side(c, own, soft, c.force_n.z), tangential_limit(row, c));
    c.force_n.x = stick.f.x;
    c.force_n.y = stick.f.y;
    c.multiplier = stick.multiplier;
}

// How far the block's equations are from holding, now that the other tools have moved on.
double block_residual_m(const ContactRow& row, const glm::dmat3& own, const Contact& c) noexcept {
    const glm::dvec3 offset_m = c.offset_m + c.others_m + own * c.force_n;
    double gap_m = offset_m.z - c.stand_m + law_at(row.law, c.x).depth_m;
    if (!std::isfinite(c.x))
        return std::numeric_limits<double>::infinity();
    if (c.force_n.z < 0.0)
        gap_m += (c.held.normal_mpn + c.multiplier) * c.force_n.z;
    const bool closed = c.x > 0.0 || c.grasped;
    const double normal_m = closed ? std::abs(gap_m) : std::max(0.0, -gap_m);
    if (!(tangential_limit(row, c) > 0.0))
        return normal_m;
    const double soft = tangential_of(row, c);
    const glm::dvec2 slip = glm::dvec2{offset_m - c.lag_m + soft * (c.force_n - c.before_n)} +
                            c.multiplier * glm::dvec2{c.force_n};
    return std::max(normal_m, glm::length(slip));
}

bool all_finite(const ContactProblem& problem,
                const std::array<ContactMemory, kTools>& memory) noexcept {
    // a sum is finite only if every term is
    glm::dvec3 sum{0.0};
    for (int i = 0; i < kTools; ++i) {
        const ContactRow& r = problem.row[i];
        if (!r.active)
            continue;
        sum += r.tip_m + r.surface_free_m + r.normal + memory[i].friction_n + memory[i].lag_m +
               memory[i].grip_m;
        sum.x += r.hold_n + memory[i].out_m + r.tip_radius_m + r.friction + memory[i].x +
                 r.law.radius_over_thickness + r.law.normal_mpn + r.law.tangential_mpn +
                 r.law.floor_mpn;
        for (int j = 0; j < kTools; ++j)
            if (problem.row[j].active)
                for (int k = 0; k < 3; ++k)
                    sum += problem.compliance[i][j][k];
    }
    return std::isfinite(sum.x + sum.y + sum.z);
}

// What the contact takes along: the lag follows the friction through the local spring, and what
// the tip is ahead of that is slip.
glm::dvec3 settle(const ContactRow& row, const glm::dmat3& own, const Contact& c,
                  ContactMemory& memory) noexcept {
    const glm::dvec3 offset_m = c.offset_m + c.others_m + own * c.force_n;
    const glm::dvec2 ahead_m{offset_m};
    memory = {.touching = c.force_n.z > 0.0, .x = c.x};
    if (!(row.friction * c.force_n.z > 0.0))
        return c.frame * glm::dvec3{ahead_m, 0.0};

    const double soft = tangential_compliance(row.law, c.x);
    glm::dvec2 lag_m = glm::dvec2{c.lag_m} - soft * glm::dvec2{c.force_n - c.before_n};
    const double length_m = glm::length(lag_m);
    // the skin that a tip holds is under it, drawn in from farther out the deeper it is
    const double most_m = row.tip_radius_m + law_at(row.law, c.x).depth_m;
    const bool too_long = length_m > most_m;
    if (too_long)
        lag_m *= most_m / length_m;
    memory.friction_n = c.frame * glm::dvec3{glm::dvec2{c.force_n}, 0.0};
    memory.lag_m = c.frame * glm::dvec3{lag_m, 0.0};
    const bool sticks = c.multiplier == 0.0 && !too_long;
    return sticks ? glm::dvec3{0.0} : c.frame * glm::dvec3{ahead_m - lag_m, 0.0};
}

// What a grasp takes along: slip across the normal is the material point's, slip along it has
// left the jaws.
glm::dvec3 settle_grasp(const glm::dmat3& own, const Contact& c, ContactMemory& memory) noexcept {
    const glm::dvec3 slip_m = -c.multiplier * c.force_n;
    const double out_m = c.force_n.z < 0.0 ? slip_m.z : 0.0;
    const glm::dvec3 offset_m = c.offset_m + c.others_m + own * c.force_n - slip_m;
    memory.touching = true;
    memory.x = c.x;
    memory.friction_n = c.frame * glm::dvec3{glm::dvec2{c.force_n}, 0.0};
    memory.lag_m = c.frame * glm::dvec3{glm::dvec2{offset_m}, 0.0};
    memory.grip_m += c.frame[2] * out_m;
    memory.out_m += out_m;
    return c.frame * glm::dvec3{glm::dvec2{slip_m}, 0.0};
}

// The contacts of one problem, numbered among the active tools.
struct Sweeps {
    int count = 0;
    std::array<int, kTools> tool{};
    std::array<Contact, kTools> contact;
    std::array<std::array<glm::dmat3, kTools>, kTools> W{}; // between contact frames
};

Sweeps make_sweeps(const ContactProblem& problem,
                   const std::array<ContactMemory, kTools>& memory) noexcept {
    Sweeps s;
    for (int i = 0; i < kTools; ++i)
        if (problem.row[i].active) {
            s.contact[s.count] = make_contact(problem.row[i], memory[i]);
            s.tool[s.count++] = i;
        }
    for (int a = 0; a < s.count; ++a)
        for (int b = 0; b < s.count; ++b)
            s.W[a][b] = glm::transpose(s.contact[a].frame) *
                        problem.compliance[s.tool[a]][s.tool[b]] * s.contact[b].frame;

    // warm start: what each tool did last time
    for (int a = 0; a < s.count; ++a)
        if (Contact& c = s.contact[a]; c.x > 0.0)
            c.force_n = {c.before_n.x, c.before_n.y,
                         law_at(problem.row[s.tool[a]].law, c.x).force_n};
    return s;
}

void gather_others(Sweeps& s, int a) noexcept {
    s.contact[a].others_m = glm::dvec3{0.0};
    for (int b = 0; b < s.count; ++b)
        if (b != a)
            s.contact[a].others_m += s.W[a][b] * s.contact[b].force_n;
}

// Every block once; returns the worst violated equation afterwards. NaN counts as infinite.
double sweep(const ContactProblem& problem, Sweeps& s) noexcept {
    for (int a = 0; a < s.count; ++a) {
        gather_others(s, a);
        solve_block(problem.row[s.tool[a]], s.W[a][a], s.contact[a]);
    }
    double worst_m = 0.0;
    for (int a = 0; a < s.count; ++a) {
        gather_others(s, a);
        const double residual_m = block_residual_m(problem.row[s.tool[a]], s.W[a][a], s.contact[a]);
        worst_m = residual_m <= worst_m ? worst_m : residual_m;
        if (!std::isfinite(worst_m))
            return std::numeric_limits<double>::infinity();
    }
    return worst_m;
}

} // namespace

ContactSolution solve_contact(const ContactProblem& problem,
                              std::array<ContactMemory, kTools>& memory) noexcept {
    ContactSolution solution;
    solution.residual_m = std::numeric_limits<double>::infinity();
    if (!all_finite(problem, memory)) {
        memory = {};
        return solution;
    }
    Sweeps s = make_sweeps(problem, memory);
    do {
        ++solution.sweeps;
        solution.residual_m = sweep(problem, s);
    } while (solution.residual_m > kTolerance_m && std::isfinite(solution.residual_m) &&
             solution.sweeps < kMaxSweeps);

    // a tool that is in nobody's reach remembers nothing
    std::array<ContactMemory, kTools> after{};
    if (std::isfinite(solution.residual_m))
        for (int a = 0; a < s.count; ++a) {
            const int i = s.tool[a];
            solution.force_n[i] = s.contact[a].frame * s.contact[a].force_n;
            if (!s.contact[a].grasped) {
                solution.slip_m[i] = settle(problem.row[i], s.W[a][a], s.contact[a], after[i]);
                continue;
            }
            after[i] = memory[i];
            solution.slip_m[i] = settle_grasp(s.W[a][a], s.contact[a], after[i]);
            if (after[i].out_m > kBite_m)
                release_grasp(after[i]);
        }
    memory = after;
    return solution;
}

glm::dvec3 predicted_slip(const ContactRow& row, const glm::dmat3& own_compliance,
                          const ContactMemory& memory) noexcept {
    Contact c = make_contact(row, memory);
    const glm::dmat3 own = glm::transpose(c.frame) * own_compliance * c.frame;
    const double normal_n = memory.touching ? law_at(row.law, c.x).force_n : 0.0;
    const double soft = tangential_compliance(row.law, c.x);
    const glm::dmat2 block = tangent_block(own, soft);
    const glm::dvec2 side = stick_side(c, own, soft, normal_n);
    const DiscPoint stick = disc_minimum(block, side, row.friction * normal_n);
    if (stick.multiplier == 0.0)
        return glm::dvec3{0.0};
    return c.frame * glm::dvec3{block * stick.f - side, 0.0};
}

} // namespace haptics

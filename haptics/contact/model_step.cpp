#include "haptics/contact/model_step.h"

#include "haptics/contact/carried_point.h"
#include "haptics/contact/grasp.h"

#include <cmath>
#include <utility>

namespace haptics {
namespace {

// Sum of a_m b_m in four strands: one strand would wait for itself.
double mode_sum(const double* a, const double* b, int modes) noexcept {
    std::array<double, 4> part{};
    int m = 0;
    for (; m + 4 <= modes; m += 4)
        for (int k = 0; k < 4; ++k)
            part[k] += a[m + k] * b[m + k];
    for (; m < modes; ++m)
        part[0] += a[m] * b[m];
    return (part[0] + part[1]) + (part[2] + part[3]);
}

// The patch as it lies with these modes; what walk() walks on.
struct DeformedPatch {
    const ToolPatch& patch;
    const double* q; // of this body

    glm::dvec3 position(int triangle, int corner) const noexcept {
        const int v = patch.triangle[triangle].vertex[corner];
        const auto& s = patch.shape[v];
        return patch.vertex[v].anchor_m + glm::dvec3{mode_sum(s[0].data(), q, patch.modes),
                                                     mode_sum(s[1].data(), q, patch.modes),
                                                     mode_sum(s[2].data(), q, patch.modes)};
    }
    int neighbour(int triangle, int corner) const noexcept {
        return patch.triangle[triangle].neighbour[corner];
    }
    SurfacePlace operator()(const SurfacePoint& at) const noexcept { // for carry()
        SurfacePlace out{.place_m = {}, .normal = glm::dvec3{0.0}};
        for (int k = 0; k < 3; ++k) {
            out.place_m += at.weight[k] * position(at.triangle, k);
            out.normal += at.weight[k] * patch.vertex[patch.triangle[at.triangle].vertex[k]].normal;
        }
        out.normal = glm::normalize(out.normal);
        return out;
    }
};

using ModeArray = std::array<double, kMaxModes>;

struct FreeMotion {
    ModeArray q{};    // where the modes would go if no tool pushed
    ModeArray soft{}; // 1 / a_m
};

FreeMotion free_motion(const RunningModel& model, double tick_s) noexcept {
    const LocalModels& a = *model.answer;
    FreeMotion f;
    for (int m = 0; m < a.modes; ++m) {
        const double inertia = 1.0 / (tick_s * tick_s) + a.damping[m] / tick_s;
        f.soft[m] = 1.0 / (inertia + a.lambda[m]);
        f.q[m] = (inertia * model.q[m] + model.rate[m] / tick_s - a.residual[m]) * f.soft[m];
    }
    return f;
}

// Motion of one contact point per mode, and the same times 1/a_m.
struct PointModes {
    std::array<ModeArray, 3> shape;
    std::array<ModeArray, 3> soft_shape;
};

// What the patch is at a surface point: the corners' values mixed.
void read_patch(const ToolPatch& patch, const SurfacePoint& at, const FreeMotion& free,
                ContactRow& row, PointModes& point) noexcept {
    row.friction = patch.friction;
    row.law = {.table = patch.table, .floor_mpn = patch.floor_mpn};
    row.surface_free_m = row.normal = glm::dvec3{0.0};
    const auto& corner = patch.triangle[at.triangle].vertex;
    for (int k = 0; k < 3; ++k) {
        const PatchVertex& v = patch.vertex[corner[k]];
        row.surface_free_m += at.weight[k] * v.anchor_m;
        row.normal += at.weight[k] * v.normal;
        row.law.radius_over_thickness += at.weight[k] * v.radius_over_thickness;
        row.law.normal_mpn += at.weight[k] * v.normal_mpn;
        row.law.tangential_mpn += at.weight[k] * v.tangential_mpn;
    }
    const double length = glm::length(row.normal);
    row.normal = length > 1e-9 ? row.normal / length : patch.vertex[corner[0]].normal;

    const double* soft = free.soft.data() + patch.first_mode;
    const auto& s0 = patch.shape[corner[0]];
    const auto& s1 = patch.shape[corner[1]];
    const auto& s2 = patch.shape[corner[2]];
    for (int axis = 0; axis < 3; ++axis) {
        for (int m = 0; m < patch.modes; ++m) {
            const double s = at.weight[0] * s0[axis][m] + at.weight[1] * s1[axis][m] +
                             at.weight[2] * s2[axis][m];
            point.shape[axis][m] = s;
            point.soft_shape[axis][m] = s * soft[m];
        }
        row.surface_free_m[axis] +=
            mode_sum(point.shape[axis].data(), free.q.data() + patch.first_mode, patch.modes);
    }
}

// W between two points on one body: column = axis of the force on j, row = motion of i.
glm::dmat3 compliance(const PointModes& i, const PointModes& j, int modes) noexcept {
    glm::dmat3 W;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            W[column][row] = mode_sum(i.shape[row].data(), j.soft_shape[column].data(), modes);
    return W;
}

bool finite(const glm::dvec3& v) noexcept {
    return std::isfinite(v.x + v.y + v.z);
}

glm::dvec3 tangential(const glm::dvec3& v, const glm::dvec3& n) noexcept {
    return v - n * glm::dot(n, v);
}

struct Scratch {
    ContactProblem problem;
    std::array<PointModes, kTools> point;
};

// What the corners lean, mixed.
glm::dmat3 lean_at(const ToolPatch& patch, const SurfacePoint& at) noexcept {
    std::array<double, 6> s{};
    const auto& corner = patch.triangle[at.triangle].vertex;
    for (int k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < s.size(); ++i)
            s[i] += at.weight[k] * patch.vertex[corner[k]].lean_mpn[i];
    return {{s[0], s[5], s[4]}, {s[5], s[1], s[3]}, {s[4], s[3], s[2]}};
}

// Carries tool i's contact point to where it belongs for this tip and fills its row. In the air
// the step is halved while it leads away from the tip: over a strongly curved surface a
// whole step overshoots. Returns false if the tool has slid off its patch.
bool place_tool(const RunningModel& model, const FreeMotion& free, int i, SurfacePoint& at,
                Scratch& scratch) noexcept {
    const ToolPatch& patch = model.answer->tool[i];
    const DeformedPatch surface{patch, free.q.data() + patch.first_mode};
    const ContactMemory& memory = model.memory[i];
    ContactRow& row = scratch.problem.row[i];
    PointModes& point = scratch.point[i];
    glm::dmat3& own = scratch.problem.compliance[i][i];

    read_patch(patch, at, free, row, point);
    own = compliance(point, point, patch.modes) + lean_at(patch, at);
    if (memory.grasped)
        return true;
    glm::dvec3 slip_m = predicted_slip(row, own, memory);
    if (slip_m == glm::dvec3{0.0})
        return true;

    const SurfacePoint start = at;
    const double distance_m = glm::length(row.tip_m - row.surface_free_m);
    bool at_rim = false;
    for (int halved = 0; halved < 4; ++halved) {
        const WalkResult walked = carry(surface, surface, start, slip_m, row.tip_m);
        at = walked.point;
        at_rim = walked.at_rim;
        read_patch(patch, at, free, row, point);
        if (memory.touching || !(glm::length(row.tip_m - row.surface_free_m) > distance_m))
            break;
        slip_m *= 0.5;
    }
    own = compliance(point, point, patch.modes) + lean_at(patch, at);
    return !at_rim ||
           glm::length(tangential(row.tip_m - row.surface_free_m, row.normal)) <= kSlideOff_m;
}

// Rows of all tools that are near something, and what they have to do with each other.
int gather_rows(RunningModel& model, const FreeMotion& free,
                const std::array<ToolTip, kTools>& tips, Scratch& scratch) noexcept {
    int slid_off = 0;
    const LocalModels& answer = *model.answer;
    for (int i = 0; i < kTools; ++i) {
        const ToolPatch& patch = answer.tool[i];
        const int triangle = model.contact[i].triangle;
        const JawGrip& grip = tips[i].grip;
        const bool closes = std::exchange(model.closing[i], grip.closing) != grip.closing;
        if (model.memory[i].grasped && (closes || !(grip.hold_n > 0.0)))
            release_grasp(model.memory[i]);
        if (!patch.near || triangle < 0 || triangle >= patch.triangles || !finite(tips[i].centre_m))
            continue;
        ContactRow& row = scratch.problem.row[i];
        row.tip_m = tips[i].centre_m;
        row.tip_radius_m = tips[i].radius_m;
        row.hold_n = grip.hold_n;
        const bool on_patch = place_tool(model, free, i, model.contact[i], scratch);
        slid_off += on_patch ? 0 : 1;
        row.active = on_patch && finite(row.surface_free_m);
        if (closes && row.active)
            begin_grasp(row, grip, model.memory[i]);
    }
    for (int i = 0; i < kTools; ++i)
        for (int j = 0; j < i; ++j) {
            const ToolPatch& a = answer.tool[i];
            const ToolPatch& b = answer.tool[j];
            if (!scratch.problem.row[i].active || !scratch.problem.row[j].active ||
                a.first_mode != b.first_mode || a.modes != b.modes)
                continue;
            scratch.problem.compliance[i][j] =
                compliance(scratch.point[i], scratch.point[j], a.modes);
            scratch.problem.compliance[j][i] = glm::transpose(scratch.problem.compliance[i][j]);
        }
    return slid_off;
}

void move_modes(RunningModel& model, const FreeMotion& free, const Scratch& scratch,
                double tick_s) noexcept {
    const LocalModels& answer = *model.answer;
    ModeArray q = free.q;
    for (int i = 0; i < kTools; ++i) {
        const glm::dvec3& F = model.force_n[i];
        if (F == glm::dvec3{0.0})
            continue;
        const PointModes& point = scratch.point[i];
        double* own = q.data() + answer.tool[i].first_mode;
        for (int m = 0; m < answer.tool[i].modes; ++m)
            own[m] -= point.soft_shape[0][m] * F.x + point.soft_shape[1][m] * F.y +
                      point.soft_shape[2][m] * F.z;
    }
    for (int m = 0; m < answer.modes; ++m) {
        model.rate[m] = (q[m] - model.q[m]) / tick_s;
        model.q[m] = q[m];
    }
}

} // namespace

StepResult step_model(RunningModel& model, double tick_s,
                      const std::array<ToolTip, kTools>& tips) noexcept {
    const FreeMotion free = free_motion(model, tick_s);
    Scratch scratch;
    StepResult result;
    result.slid_off = gather_rows(model, free, tips, scratch);

    const ContactSolution solved = solve_contact(scratch.problem, model.memory);
    model.force_n = solved.force_n;
    result.solve_residual_m = solved.residual_m;
    move_modes(model, free, scratch, tick_s);

    // what the tips still have to slide over the surface
    for (int i = 0; i < kTools; ++i) {
        if (!scratch.problem.row[i].active)
            continue;
        result.touching[i] = model.memory[i].touching;
        result.grasping[i] = model.memory[i].grasped;
        result.normal[i] = scratch.problem.row[i].normal;
        if (!result.touching[i] || solved.slip_m[i] == glm::dvec3{0.0})
            continue;
        const ToolPatch& patch = model.answer->tool[i];
        const DeformedPatch surface{patch, model.q.data() + patch.first_mode};
        const WalkResult walked =
            carry(surface, surface, model.contact[i], solved.slip_m[i], tips[i].centre_m);
        model.contact[i] = walked.point;
        if (walked.at_rim && model.memory[i].grasped)
            release_grasp(model.memory[i]);
    }
    ++model.tick;
    return result;
}

} // namespace haptics

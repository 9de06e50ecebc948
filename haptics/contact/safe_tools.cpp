#include "haptics/contact/safe_tools.h"

#include "haptics/contact/path_planes.h"
#include "haptics/contact/proxy_parts.h"
#include "haptics/contact/safe_proxy.h"
#include "haptics/contact/tool_path.h"
#include "haptics/contact/tool_ride.h"

namespace haptics {
namespace {

using glm::dvec3;

bool finite(const ToolInput& in) noexcept {
    const dvec3 sum = in.device_m + in.shape.pivot_m;
    return std::isfinite(sum.x + sum.y + sum.z + in.shape.tip_radius_m + in.shape.shaft_radius_m +
                         in.stiffness_npm + in.static_friction + in.dynamic_friction) &&
           in.shape.tip_radius_m >= 0.0 && in.shape.shaft_radius_m >= 0.0;
}

// What a tick needs to know of all tools.
struct Tick {
    std::span<const ToolInput> in;
    ToolsState& state;
    std::array<bool, kMostTools> goes{};
    std::array<double, kMostTools> way_m{}, catch_up_m{}; // the device's; without being felt
    std::array<ToolYields, kMostTools> yields{};
    std::array<double, kMostTools> pushed_m{};                        // by the farthest of them
    std::array<std::array<bool, kMostTools>, kMostTools> waits_for{}; // [pusher][who gives way]
};

void start(const MeshView& mesh, const ToolInput& in, ToolState& state) noexcept {
    if (!state.started) {
        state = {};
        state.started = true;
        state.tip_m = state.device_m = in.device_m;
        // two tools are up to four radii thick, and a pivot's coordinates are rounded as well
        const double far_m = std::max({std::abs(in.shape.pivot_m.x), std::abs(in.shape.pivot_m.y),
                                       std::abs(in.shape.pivot_m.z)});
        const double size_m = std::max(4.0 * thickest(in.shape), 0.0);
        state.hover_m =
            hover_of(mesh,
                     {.device_m = in.device_m,
                      .radius_m = in.shape.shaft_radius_m > 0.0 ? size_m : in.shape.tip_radius_m}) +
            1024.0 * std::numeric_limits<double>::epsilon() *
                (in.shape.shaft_radius_m > 0.0 ? far_m : 0.0);
    }
    state.shape = in.shape;
}

// How far along `n` the tip would go from here without contact with one other tool.
double free_way_m(const Tick& tick, int tool, int without, const dvec3& n) noexcept {
    const ToolState& s = tick.state.tool[tool];
    std::array<Plane, kMostToolContacts> plane;
    std::size_t planes = 0;
    for (int i = 0; i < s.contacts; ++i)
        if (s.contact[i].tool != without)
            plane[planes++] = {s.contact[i].normal, glm::dot(s.contact[i].normal, s.tip_m)};
    const PlaneSolution to =
        nearest_in_planes(std::span<const Plane>(plane).first(planes), tick.in[tool].device_m);
    return to.feasible ? glm::dot(n, to.place_m - s.tip_m) : 0.0;
}

void give_way(Tick& tick, int tool, const ToolTouch& at, double way_m) noexcept {
    ToolYields& yields = tick.yields[tool];
    const double most_m = tick.catch_up_m[tool] + 4.0 * (tick.way_m[tool] + tick.way_m[at.tool]);
    const double pushed_m = std::min(way_m, most_m);
    if (yields.count == ToolYields::kRoom || !(pushed_m > 0.0))
        return;
    yields.from[yields.count] = at;
    yields.plane[yields.count++] = {at.normal,
                                    glm::dot(at.normal, tick.state.tool[tool].tip_m) + pushed_m};
    tick.pushed_m[tool] = std::max(tick.pushed_m[tool], pushed_m);
    tick.waits_for[at.tool][tool] = true;
}

// A touch of two tools, as each of them sees it.
struct Shared {
    ToolTouch a, b;
};

// Where they are pressed together, to where both springs push equally. Nearer to a pivot than this
// a contact is not moved: the tip would have to go too far.
void share(Tick& tick, const Shared& at) noexcept {
    constexpr double kLeastLever = 0.05;
    const int a = at.b.tool, b = at.a.tool;
    const double lever_a = at.a.lever, lever_b = at.b.lever;
    if (std::min(lever_a, lever_b) < kLeastLever)
        return;
    const double wish_a = lever_a * free_way_m(tick, a, b, at.a.normal);
    const double wish_b = lever_b * free_way_m(tick, b, a, at.a.normal);
    const double ka = tick.in[a].stiffness_npm / (lever_a * lever_a);
    const double kb = tick.in[b].stiffness_npm / (lever_b * lever_b);
    if (!(wish_a < wish_b) || !(ka + kb > 0.0))
        return; // they part
    const double way_m = (ka * wish_a + kb * wish_b) / (ka + kb);
    if (way_m > 0.0)
        give_way(tick, a, at.a, way_m / lever_a);
    else
        give_way(tick, b, at.b, -way_m / lever_b);
}

void share_touches(Tick& tick, int a, int b) noexcept {
    const ToolState &sa = tick.state.tool[a], &sb = tick.state.tool[b];
    const OtherTools all = others_of(a, tick.state);
    for (int i = 0; i < all.count; ++i)
        for (const ToolPart part : kToolParts) {
            const Obstacle& other = all.part[i];
            if (other.tool != b || !has(sa.shape, part))
                continue;
            const SegmentPair pair = part_to_triangle(sa.shape, part, sa.tip_m, other.corner);
            const double distance = std::sqrt(pair.on_triangle.distance2_m2);
            const double rest_m = radius_of(sa.shape, part) + other.grown_m;
            if (!(distance > 0.0 && distance <= rest_m + 2.0 * std::max(sa.hover_m, sb.hover_m)))
                continue;
            const dvec3 n = (pair.place_m - pair.on_triangle.place_m) / distance;
            // a tip is a triangle of one point
            const bool tip = other.corner[0] == other.corner[1];
            share(tick, {{.part = part, .lever = pair.along, .tool = b, .normal = n},
                         {.part = tip ? ToolPart::tip : ToolPart::shaft,
                          .lever = tip ? 1.0 : 1.0 - pair.on_triangle.weight.x,
                          .tool = a,
                          .normal = -n}});
        }
}

void ride(const CollisionIndex& index, const MeshView& mesh, Tick& tick, int i) noexcept {
    ToolState& s = tick.state.tool[i];
    const dvec3 start_m = s.tip_m;
    ride_along(index, mesh, others_of(i, tick.state), s);
    tick.catch_up_m[i] =
        std::max(tick.catch_up_m[i] - glm::length(s.tip_m - start_m), 0.2 * tick.catch_up_m[i]);
}

void move(const CollisionIndex& index, const MeshView& mesh, Tick& tick, int i) noexcept {
    ToolState& s = tick.state.tool[i];
    const ToolInput& in = tick.in[i];
    approach(index, mesh, others_of(i, tick.state), tick.yields[i], in,
             tick.way_m[i] + tick.catch_up_m[i] + tick.pushed_m[i], s);
    s.device_m = in.device_m;
    s.sliding = s.sliding && s.touching;
    s.force_n = in.stiffness_npm * (s.tip_m - in.device_m);
}

// Those who give way before those who push; in a circle the first.
void move_all(const CollisionIndex& index, const MeshView& mesh, Tick& tick) noexcept {
    std::array<bool, kMostTools> left = tick.goes;
    for (int round = 0; round < kMostTools; ++round) {
        int next = -1, first = -1;
        for (int i = kMostTools - 1; i >= 0; --i) {
            if (!left[i])
                continue;
            first = i;
            bool waits = false;
            for (int other = 0; other < kMostTools; ++other)
                waits = waits || (left[other] && tick.waits_for[i][other]);
            if (!waits)
                next = i;
        }
        next = next < 0 ? first : next;
        if (next < 0)
            return;
        left[next] = false;
        move(index, mesh, tick, next);
    }
}

} // namespace

void step_safe_tools(const CollisionIndex& index, const MeshView& mesh,
                     std::span<const ToolInput> in, ToolsState& state) noexcept {
    Tick tick{.in = in.first(std::min<std::size_t>(in.size(), kMostTools)), .state = state};
    const int tools = static_cast<int>(tick.in.size());
    for (int i = 0; i < kMostTools; ++i) {
        ToolState& s = state.tool[i];
        s.force_n = dvec3{0.0};
        tick.goes[i] = i < tools && finite(in[i]);
        if (i >= tools)
            s.started = false;
        if (!tick.goes[i])
            continue;
        start(mesh, in[i], s);
        tick.way_m[i] = glm::length(in[i].device_m - s.device_m);
        tick.catch_up_m[i] = in[i].stiffness_npm > 0.0 ? kCatchUp_n / in[i].stiffness_npm : 0.0;
    }
    for (int i = 0; i < kMostTools && !mesh.before_m.empty(); ++i)
        if (tick.goes[i])
            ride(index, mesh, tick, i);
    for (int a = 0; a < kMostTools; ++a)
        for (int b = a + 1; b < kMostTools; ++b)
            if (tick.goes[a] && tick.goes[b])
                share_touches(tick, a, b);
    move_all(index, mesh, tick);
}

} // namespace haptics

// tests/bench/embree_peer.cpp
// Embree 3's closest point (rtcPointQuery with a user function) on the contact workload: a program
// that prints one JSON object with two rows, "fresh": every query begins with the given reach, and
// "warm": it begins with the distance to the triangle of the last answer. One thread; refit by
// RTC_BUILD_QUALITY_REFIT. Arithmetic in float, as in Embree's own closest-point tutorial.
#include "tests/bench/peer.h"

#include <cmath>
#include <cstring>
#include <embree3/rtcore.h>
#include <glm/geometric.hpp>
#include <memory>
#include <stdexcept>

namespace {

using glm::vec3;

/// Ericson, Real-Time Collision Detection, 5.1.5.
vec3 closest_on_triangle(const vec3& p, const vec3& a, const vec3& b, const vec3& c) noexcept {
    const vec3 ab = b - a, ac = c - a, ap = p - a;
    const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0.0f && d2 <= 0.0f)
        return a;
    const vec3 bp = p - b;
    const float d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0.0f && d4 <= d3)
        return b;
    const vec3 cp = p - c;
    const float d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0.0f && d5 <= d6)
        return c;
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f)
        return a + d1 / (d1 - d3) * ab;
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f)
        return a + d2 / (d2 - d6) * ac;
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f)
        return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    const float scale = 1.0f / (va + vb + vc);
    return a + vb * scale * ab + vc * scale * ac;
}

struct Scene {
    RTCDevice device = rtcNewDevice("threads=1,user_threads=1");
    RTCScene scene = nullptr;
    RTCGeometry geometry = nullptr;
    float* vertex = nullptr;               // x y z and one that pads, owned by Embree
    const std::uint32_t* corner = nullptr; // three of each triangle

    ~Scene() {
        if (scene != nullptr)
            rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    vec3 at(std::uint32_t v) const noexcept {
        return {vertex[4 * v], vertex[4 * v + 1], vertex[4 * v + 2]};
    }
    float distance(std::uint32_t t, const vec3& p) const noexcept {
        const std::uint32_t* c = corner + 3 * t;
        return glm::length(p - closest_on_triangle(p, at(c[0]), at(c[1]), at(c[2])));
    }
};

struct Nearest {
    const Scene* scene = nullptr;
    std::uint32_t triangle = RTC_INVALID_GEOMETRY_ID;
};

bool look(RTCPointQueryFunctionArguments* arguments) {
    auto& best = *static_cast<Nearest*>(arguments->userPtr);
    RTCPointQuery& q = *arguments->query;
    const float d = best.scene->distance(arguments->primID, {q.x, q.y, q.z});
    if (!(d < q.radius))
        return false;
    q.radius = d;
    best.triangle = arguments->primID;
    return true;
}

void set_places(Scene& scene, const haptics::MeshView& mesh) {
    for (std::size_t v = 0; v < mesh.vertex_m.size(); ++v)
        for (int axis = 0; axis < 3; ++axis)
            scene.vertex[4 * v + axis] = static_cast<float>(mesh.vertex_m[v][axis]);
}

std::shared_ptr<Scene> make_scene(const haptics::MeshView& mesh) {
    auto out = std::make_shared<Scene>();
    out->scene = rtcNewScene(out->device);
    // low quality is what makes a tree per geometry, the only kind that Embree refits; that tree
    // itself is built with the surface-area heuristic
    rtcSetSceneFlags(out->scene, RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(out->scene, RTC_BUILD_QUALITY_LOW);
    RTCGeometry g = rtcNewGeometry(out->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    out->vertex = static_cast<float*>(rtcSetNewGeometryBuffer(
        g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 16, mesh.vertex_m.size()));
    void* const corners = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12,
                                                  mesh.triangle.size());
    if (out->vertex == nullptr || corners == nullptr)
        throw std::runtime_error("Embree gives no buffers");
    std::memcpy(corners, mesh.triangle.data(), mesh.triangle.size_bytes());
    out->corner = static_cast<const std::uint32_t*>(corners);
    set_places(*out, mesh);
    rtcSetGeometryPointQueryFunction(g, look);
    rtcSetGeometryBuildQuality(g, RTC_BUILD_QUALITY_REFIT);
    rtcCommitGeometry(g);
    rtcAttachGeometry(out->scene, g);
    rtcReleaseGeometry(g); // the scene holds it
    out->geometry = g;
    rtcCommitScene(out->scene);
    if (rtcGetDeviceError(out->device) != RTC_ERROR_NONE)
        throw std::runtime_error("Embree reports an error");
    return out;
}

bench::Peer make_embree(const haptics::MeshView& mesh, double reach_m, bool warm) {
    const std::shared_ptr<Scene> scene = make_scene(mesh);
    const auto last = std::make_shared<std::uint32_t>(RTC_INVALID_GEOMETRY_ID);
    const auto take = [scene](const haptics::MeshView& moved) { set_places(*scene, moved); };
    const auto refit = [scene] {
        rtcUpdateGeometryBuffer(scene->geometry, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(scene->geometry);
        rtcCommitScene(scene->scene);
    };
    const auto ask = [scene, last, warm,
                      reach = static_cast<float>(reach_m)](const glm::dvec3& place) {
        const vec3 p(place);
        RTCPointQuery query{p.x, p.y, p.z, 0.0f, reach};
        Nearest best{scene.get()};
        if (warm && *last != RTC_INVALID_GEOMETRY_ID)
            if (const float d = scene->distance(*last, p); d < reach) {
                best.triangle = *last;
                query.radius = d;
            }
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        rtcPointQuery(scene->scene, &query, &context, nullptr, &best);
        *last = best.triangle;
        return bench::PeerAnswer{best.triangle != RTC_INVALID_GEOMETRY_ID,
                                 static_cast<double>(query.radius)};
    };
    return {.name = warm ? "embree-warm" : "embree",
            .closest = true,
            .take = take,
            .refit = refit,
            .ask = ask};
}

} // namespace

int main(int argc, char** argv) {
    return bench::peer_main(argc, argv, [](const bench::PeerOptions& o, const auto& work) {
        nlohmann::ordered_json both;
        for (const bool warm : {false, true})
            both[warm ? "warm" : "fresh"] =
                bench::run_peer(o, work, [&](const haptics::MeshView& mesh) {
                    return make_embree(mesh, o.reach_m, warm);
                });
        return both;
    });
}

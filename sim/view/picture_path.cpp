// sim/view/picture_path.cpp
// The path of follow-path as a ribbon on the tissue: a line to draw along between the rims of what
// is allowed.
#include "sim/view/camera_matrix.h"
#include "sim/view/picture.h"
#include "sim/view/tool_mesh.h"

namespace view {
namespace {

constexpr float kLift_m = 0.003F; // less than targets, which lie on top

struct Vertex {
    glm::vec3 place_m;
    glm::vec2 on_path;
};

std::vector<Vertex> ribbon(const PathView& path) {
    std::vector<Vertex> strip;
    const std::size_t n = path.place_m.size();
    strip.reserve(2 * n);
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec3 along =
            path.place_m[std::min(i + 1, n - 1)] - path.place_m[i > 0 ? i - 1 : 0];
        const glm::dvec3 side = glm::cross(along, path.normal[i]);
        const double length = glm::length(side);
        const glm::dvec3 half =
            length > 0.0 ? path.radius_m / length * side : glm::dvec3{path.radius_m, 0.0, 0.0};
        for (const float across : {-1.0F, 1.0F})
            strip.push_back({glm::vec3(path.place_m[i] + double(across) * half),
                             {across, static_cast<float>(i)}});
    }
    return strip;
}

} // namespace

void Picture::draw_path(const ViewFrame& frame, const glm::mat4& to_clip) {
    const PathView& path = frame.path;
    if (path.place_m.size() < 2 || path.normal.size() != path.place_m.size())
        return;
    const std::vector<Vertex> strip = ribbon(path);
    see(path_, frame.camera, to_clip);
    path_.set("lift_m", kLift_m);
    path_.set("base", role_colour(path.role));
    path_.set("done", static_cast<float>(path.done * double(path.place_m.size() - 1)));
    glBindVertexArray(ribbon_.id());
    glBindBuffer(GL_ARRAY_BUFFER, ribbon_places_.id());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(strip.size() * sizeof(Vertex)),
                 strip.data(), GL_STREAM_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), nullptr);
    glEnableVertexAttribArray(1);
    glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                          reinterpret_cast<const void*>(sizeof(glm::vec3)));
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    path_.set("opacity", 0.25F); // faint where something stands before it
    glDepthFunc(GL_GREATER);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, static_cast<GLsizei>(strip.size()));
    path_.set("opacity", 1.0F);
    glDepthFunc(GL_LESS);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, static_cast<GLsizei>(strip.size()));
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

} // namespace view

// sim/view/picture.cpp
// Uploads what changed, then draws near things with depth and targets on top of the tissue.
#include "sim/view/picture.h"

#include "sim/view/camera_matrix.h"
#include "sim/view/light.h"
#include "sim/view/noise.h"
#include "sim/view/open_sky.h"
#include "sim/view/shaders.h"
#include "sim/view/tissue_style.h"
#include "sim/view/tool_mesh.h"

namespace view {
namespace {

constexpr GLuint kPosition = 0, kNormal = 1, kRest = 2, kSky = 3;

void attribute(const Buffer& buffer, GLuint slot, int stride_floats, int first_float) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
    glEnableVertexAttribArray(slot);
    glVertexAttribPointer(slot, std::min(3, stride_floats), GL_FLOAT, GL_FALSE,
                          static_cast<GLsizei>(stride_floats * sizeof(float)),
                          reinterpret_cast<const void*>(first_float * sizeof(float)));
}

template <class Items>
void store(GLenum kind, const Buffer& buffer, const Items& items, GLenum usage) {
    glBindBuffer(kind, buffer.id());
    glBufferData(kind, static_cast<GLsizeiptr>(items.size() * sizeof(items[0])), items.data(),
                 usage);
}

Texture noise_texture() {
    Texture texture = make_texture();
    const std::vector<std::uint8_t> values = noise_tile();
    glBindTexture(GL_TEXTURE_2D, texture.id());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kNoiseSide, kNoiseSide, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 values.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return texture; // repeats in both directions by default
}

/// Shading that is not needed is not compiled in: a software renderer pays for every line.
std::size_t tissue_program(bool fine, bool near) {
    return (fine ? 1U : 0U) + (near ? 2U : 0U);
}
Program make_tissue(bool fine, bool near) {
    return {"tissue",
            std::string(shaders::prelude) + (fine ? "#define FINE\n" : "") +
                (near ? "#define NEAR\n" : ""),
            shaders::tissue_vertex, shaders::tissue_fragment};
}

/// Whether the tip is within reach of its own shadow, by some of the vertices.
bool casts_shadow(const ToolView& tool, const SurfaceView& surface) {
    constexpr float kNear2_m2 = 0.045F * 0.045F;
    const glm::vec3 tip_m(tool.tip_m);
    for (std::size_t i = 0; tool.present && i < surface.position_m.size(); i += 3) {
        const glm::vec3 w = surface.position_m[i] - tip_m;
        if (glm::dot(w, w) < kNear2_m2)
            return true;
    }
    return false;
}

struct Shadows {
    std::array<glm::vec4, kTools> tip{}; // centre, radius
    std::array<glm::vec3, kTools> back{};
    int count = 0;
};
Shadows shadows_on(const ViewFrame& frame, const SurfaceView& surface) {
    Shadows shadows;
    for (const ToolView& tool : frame.tools) {
        if (!casts_shadow(tool, surface))
            continue;
        shadows.tip[shadows.count] = glm::vec4(glm::vec3(tool.tip_m), tool.tip_radius_m);
        shadows.back[shadows.count++] = glm::vec3(-tool.direction);
    }
    return shadows;
}

void set_style(const Program& program, const TissueStyle& style) {
    program.set("deep", style.deep);
    program.set("pale", style.pale);
    program.set("vein", style.vein);
    program.set("tiles", glm::vec3(style.coarse_tiles_1pm, style.fine_tiles_1pm, style.fine_share));
    program.set("veins", glm::vec3(style.veins, style.small_veins, 0.0F));
    program.set("film_of", glm::vec3(style.wet, style.bumps, 0.0F));
}

} // namespace

Picture::Picture()
    : tissue_{make_tissue(false, false), make_tissue(true, false), make_tissue(false, true),
              make_tissue(true, true)},
      tool_("tool", shaders::prelude, shaders::tool_vertex, shaders::tool_fragment),
      target_("target", shaders::prelude, shaders::target_vertex, shaders::target_fragment),
      path_("path", shaders::prelude, shaders::path_vertex, shaders::path_fragment),
      noise_(noise_texture()), cylinder_(make_solid(false)), ball_(make_solid(true)),
      ribbon_(make_vertex_array()), ribbon_places_(make_buffer()), square_(make_vertex_array()) {}

/// A unit ball, or a unit cylinder with closed ends, z 0..1; positions and normals interleaved.
Picture::Solid Picture::make_solid(bool ball) {
    constexpr int kAround = 28, kRings = 14;
    struct Vertex {
        glm::vec3 position, normal;
    };
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    const auto ring = [&](float radius, float z, float normal_out, float normal_z) {
        for (int i = 0; i <= kAround; ++i) {
            const float a = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / kAround;
            const glm::vec2 u(std::cos(a), std::sin(a));
            vertices.push_back({{radius * u, z}, {normal_out * u, normal_z}});
        }
    };
    if (ball)
        for (int j = 0; j <= kRings; ++j) {
            const float b = std::numbers::pi_v<float> * static_cast<float>(j) / kRings;
            ring(std::sin(b), -std::cos(b), std::sin(b), -std::cos(b));
        }
    else
        for (const glm::vec4& r :
             {glm::vec4(0, 0, 0, -1), glm::vec4(1, 0, 0, -1), glm::vec4(1, 0, 1, 0),
              glm::vec4(1, 1, 1, 0), glm::vec4(1, 1, 0, 1), glm::vec4(0, 1, 0, 1)})
            ring(r.x, r.y, r.z, r.w);
    const std::uint32_t row = kAround + 1, rows = static_cast<std::uint32_t>(vertices.size()) / row;
    for (std::uint32_t j = 0; j + 1 < rows; ++j)
        for (std::uint32_t i = 0; i < kAround; ++i) {
            const std::uint32_t a = j * row + i, b = a + row;
            indices.insert(indices.end(), {a, a + 1, b, b, a + 1, b + 1});
        }
    Solid solid{make_vertex_array(), make_buffer(), make_buffer(),
                static_cast<GLsizei>(indices.size())};
    glBindVertexArray(solid.array.id());
    store(GL_ARRAY_BUFFER, solid.vertices, vertices, GL_STATIC_DRAW);
    attribute(solid.vertices, kPosition, 6, 0);
    attribute(solid.vertices, kNormal, 6, 3);
    store(GL_ELEMENT_ARRAY_BUFFER, solid.index, indices, GL_STATIC_DRAW);
    return solid;
}

Picture::Uploaded& Picture::uploaded(const ViewFrame& frame, std::size_t index) {
    const SurfaceView& surface = frame.surfaces[index];
    Uploaded& up = surface_[surface.id];
    up.used = true;
    if (up.array.id() == 0) {
        up = {make_vertex_array(), make_buffer(), make_buffer(),
              make_buffer(),       make_buffer(), make_buffer()};
        up.used = true;
        up.vertices = static_cast<GLsizei>(surface.rest_m.size());
        up.indices = static_cast<GLsizei>(3 * surface.triangles.size());
        glBindVertexArray(up.array.id());
        store(GL_ELEMENT_ARRAY_BUFFER, up.index, surface.triangles, GL_STATIC_DRAW);
        store(GL_ARRAY_BUFFER, up.rest, surface.rest_m, GL_STATIC_DRAW);
        attribute(up.rest, kRest, 3, 0);
        store(GL_ARRAY_BUFFER, up.sky, open_sky(frame.surfaces, index), GL_STATIC_DRAW);
        attribute(up.sky, kSky, 1, 0);
        attribute(up.position, kPosition, 3, 0);
        attribute(up.normal, kNormal, 3, 0);
    }
    glBindVertexArray(up.array.id());
    store(GL_ARRAY_BUFFER, up.position, surface.position_m, GL_STREAM_DRAW);
    store(GL_ARRAY_BUFFER, up.normal, surface.normal, GL_STREAM_DRAW);
    return up;
}

void Picture::see(const Program& program, const Camera& camera, const glm::mat4& to_clip) const {
    program.use();
    program.set("to_clip", to_clip);
    program.set("eye_m", glm::vec3(camera.eye_m));
    program.set("ahead", glm::vec3(glm::normalize(camera.look_at_m - camera.eye_m)));
    program.set("lamp_size2_m2", static_cast<float>(kLampSize2_m2));
    program.set("exposure", static_cast<float>(exposure_));
}

/// The camera's exposure follows what it sees, slowly, as a real one does.
void Picture::expose(const ViewFrame& frame) {
    const double wish = exposure(frame);
    exposure_ += (wish - exposure_) * (exposure_ > 0.0 ? 0.05 : 1.0);
    if (frame.surfaces.empty())
        exposure_ = 0.0; // whatever comes next is a new world
}

void Picture::draw_surface(const ViewFrame& frame, std::size_t index, const glm::mat4& to_clip) {
    const SurfaceView& surface = frame.surfaces[index];
    const std::size_t n = surface.rest_m.size();
    if (n == 0 || surface.position_m.size() != n || surface.normal.size() != n)
        return; // not published yet
    const TissueStyle& style = style_of(surface.look);
    const Shadows shadows = shadows_on(frame, surface);
    const Program& program =
        tissue_[tissue_program(style.fine_tiles_1pm > 0.0F, shadows.count > 0)];
    see(program, frame.camera, to_clip);
    program.set("noise", 0);
    set_style(program, style);
    program.set("tools", shadows.count);
    program.set("tip", shadows.tip.data(), kTools);
    program.set("back", shadows.back.data(), kTools);
    const Uploaded& up = uploaded(frame, index);
    glDrawElements(GL_TRIANGLES, up.indices, GL_UNSIGNED_INT, nullptr);
}

void Picture::draw_tissue(const ViewFrame& frame, const glm::mat4& to_clip) {
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, noise_.id());
    glEnable(GL_CULL_FACE);
    for (auto& [id, up] : surface_)
        up.used = false;
    for (const bool walls : {false, true}) // walls last: what organs hide is never shaded
        for (std::size_t i = 0; i < frame.surfaces.size(); ++i)
            if ((frame.surfaces[i].look == Look::wall) == walls)
                draw_surface(frame, i, to_clip);
    std::erase_if(surface_, [](const auto& entry) { return !entry.second.used; });
    glDisable(GL_CULL_FACE);
}

void Picture::draw_tools(const ViewFrame& frame, const glm::mat4& to_clip) {
    see(tool_, frame.camera, to_clip);
    for (const ToolView& tool : frame.tools) {
        if (!tool.present)
            continue;
        for (const ToolPart& part : tool_parts(tool)) {
            const Solid& solid = part.form == ToolPart::Form::ball ? ball_ : cylinder_;
            tool_.set("model", part.model);
            tool_.set("base", part.base);
            tool_.set("metal", part.metal);
            glBindVertexArray(solid.array.id());
            glDrawElements(GL_TRIANGLES, solid.indices, GL_UNSIGNED_INT, nullptr);
        }
    }
}

void Picture::draw(const ViewFrame& frame, const Digits& digits, const Lens& lens, int height_px) {
    lens_ = lens;
    height_px_ = height_px;
    expose(frame);
    const glm::mat4 to_clip(projection_matrix(frame.camera, lens) * view_matrix(frame.camera));
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_CULL_FACE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glClearColor(0.030F, 0.010F, 0.010F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    draw_tools(frame, to_clip); // nearest first: what they hide is never shaded
    draw_tissue(frame, to_clip);
    draw_path(frame, to_clip);
    draw_targets(frame, digits, to_clip);
    glBindVertexArray(0);
}

} // namespace view

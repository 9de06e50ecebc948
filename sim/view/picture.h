// sim/view/picture.h
// The 3-D picture: tissue, instruments, targets, as the endoscope sees them. Draws into whatever
// target is bound. Called by Window, in the render thread.
#pragma once

#include "sim/view/frame.h"
#include "sim/view/gl_objects.h"

#include <map>

namespace view {

/// Where a digit lies in the font's texture, and its shape relative to the digit height.
struct Glyph {
    glm::vec4 uv{0.0F}; // left, bottom, right, top
    float width = 0.6F; // over height
    float advance = 0.65F;
};

/// The digits 0-9 and the texture that holds them.
struct Digits {
    GLuint texture = 0;
    std::array<Glyph, 10> glyph{};
};

class Picture {
  public:
    Picture();
    /// `width_px`, `height_px`: of the bound target.
    void draw(const ViewFrame& frame, const Digits& digits, int width_px, int height_px);

  private:
    struct Uploaded {
        VertexArray array;
        Buffer position, normal, rest, index;
        GLsizei indices = 0, vertices = 0;
        bool used = false;
    };
    struct Solid {
        VertexArray array;
        Buffer vertices, index;
        GLsizei indices = 0;
    };
    static Solid make_solid(bool ball);
    Uploaded& uploaded(const SurfaceView& surface);
    void see(const Program& program, const Camera& camera, const glm::mat4& to_clip) const;
    void draw_tissue(const ViewFrame& frame, const glm::mat4& to_clip);
    void draw_surfaces(const ViewFrame& frame, const Program& program, Material material);
    void draw_tools(const ViewFrame& frame, const glm::mat4& to_clip);
    void draw_targets(const ViewFrame& frame, const Digits& digits, const glm::mat4& to_clip);
    void draw_target(const ViewFrame& frame, const TargetView& target, const Digits& digits,
                     bool hidden);

    Program organ_, wall_, tool_, target_;
    Texture noise_;
    Solid cylinder_, ball_;
    VertexArray square_; // no attributes: corners come from gl_VertexID
    std::map<int, Uploaded> surface_;
};

} // namespace view

// sim/view/picture.h
// The 3-D picture: tissue, instruments, targets, as a pinhole at the endoscope's tip sees them; its
// lens is Optics. Draws into whatever target is bound. Called by Window, in the render thread.
#pragma once

#include "sim/view/frame.h"
#include "sim/view/gl_objects.h"
#include "sim/view/lens.h"

#include <map>
#include <string_view>

namespace view {

/// Where a digit lies in the font's texture, and its shape relative to the digit height.
struct Glyph {
    glm::vec4 uv{0.0F}; // left, bottom, right, top
    float width = 0.6F; // over height
    float advance = 0.65F;
};

/// What stands on marks: a number, or a role's letter in the order of Role.
inline constexpr std::string_view kGlyphs = "0123456789LRAE";

/// kGlyphs and the texture that holds them.
struct Digits {
    GLuint texture = 0;
    std::array<Glyph, kGlyphs.size()> glyph{};
};

class Picture {
  public:
    Picture();
    /// What `lens` needs, whatever the bound target's size; `height_px`: of the window.
    void draw(const ViewFrame& frame, const Digits& digits, const Lens& lens, int height_px);

  private:
    struct Uploaded {
        VertexArray array;
        Buffer position, normal, rest, sky, index;
        GLsizei indices = 0, vertices = 0;
        bool used = false;
    };
    struct Solid {
        VertexArray array;
        Buffer vertices, index;
        GLsizei indices = 0;
    };
    static Solid make_solid(bool ball);
    Uploaded& uploaded(const ViewFrame& frame, std::size_t index);
    void see(const Program& program, const Camera& camera, const glm::mat4& to_clip) const;
    void expose(const ViewFrame& frame);
    void draw_tissue(const ViewFrame& frame, const glm::mat4& to_clip);
    void draw_surface(const ViewFrame& frame, std::size_t index, const glm::mat4& to_clip);
    void draw_tools(const ViewFrame& frame, const glm::mat4& to_clip);
    void draw_targets(const ViewFrame& frame, const Digits& digits, const glm::mat4& to_clip);
    void draw_path(const ViewFrame& frame, const glm::mat4& to_clip);
    void draw_target(const ViewFrame& frame, const TargetView& target, const Digits& digits,
                     bool hidden);

    std::array<Program, 4> tissue_; // see tissue_program()
    Program tool_, target_, path_;
    Texture noise_;
    Solid cylinder_, ball_;
    VertexArray ribbon_;
    Buffer ribbon_places_;
    VertexArray square_; // no attributes: corners come from gl_VertexID
    std::map<int, Uploaded> surface_;
    Lens lens_;
    int height_px_ = 0;
    double exposure_ = 0.0; // follows what is seen; 0: nothing seen yet
};

} // namespace view

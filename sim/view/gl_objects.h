// sim/view/gl_objects.h
// OpenGL names with an owner: buffers, programs, pictures to draw into. Used by the files of
// sim/view that draw, in the render thread, while the window's context is current.
#pragma once

#include <string>
#include <utility>

#include <epoxy/gl.h>

#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace view {

/// One OpenGL name; `Release` deletes it. Moves, never copies.
template <class Release> class Name {
  public:
    Name() = default;
    explicit Name(GLuint id) noexcept : id_(id) {}
    Name(Name&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
    Name& operator=(Name&& other) noexcept {
        std::swap(id_, other.id_);
        return *this;
    }
    ~Name() {
        if (id_ != 0)
            Release{}(id_);
    }
    GLuint id() const noexcept { return id_; }

  private:
    GLuint id_ = 0;
};

struct ReleaseBuffer {
    void operator()(GLuint id) const { glDeleteBuffers(1, &id); }
};
struct ReleaseArray {
    void operator()(GLuint id) const { glDeleteVertexArrays(1, &id); }
};
struct ReleaseTexture {
    void operator()(GLuint id) const { glDeleteTextures(1, &id); }
};
struct ReleaseFrame {
    void operator()(GLuint id) const { glDeleteFramebuffers(1, &id); }
};
struct ReleaseStore {
    void operator()(GLuint id) const { glDeleteRenderbuffers(1, &id); }
};
struct ReleaseProgram {
    void operator()(GLuint id) const { glDeleteProgram(id); }
};
using Buffer = Name<ReleaseBuffer>;
using VertexArray = Name<ReleaseArray>;
using Texture = Name<ReleaseTexture>;

Buffer make_buffer();
VertexArray make_vertex_array();
Texture make_texture();

/// A vertex and a fragment shader, linked. Uniforms by name; an unknown name sets nothing.
class Program {
  public:
    /// `prelude` stands before both. Throws WindowError with the compiler's words.
    Program(const char* name, const std::string& prelude, const char* vertex, const char* fragment);
    void use() const { glUseProgram(name_.id()); }
    void set(const char* uniform, int value) const;
    void set(const char* uniform, const glm::vec2& value) const;
    void set(const char* uniform, float value) const;
    void set(const char* uniform, const glm::vec3& value) const;
    void set(const char* uniform, const glm::vec4& value) const;
    void set(const char* uniform, const glm::mat4& value) const;
    void set(const char* uniform, const glm::vec4* values, int count) const;
    void set(const char* uniform, const glm::vec3* values, int count) const;

  private:
    Name<ReleaseProgram> name_;
};

/// Colour (and depth) to draw into. `samples` above 1: must be resolved by blit_to(), and has no
/// texture.
class Target {
  public:
    /// Nothing happens if size and samples are as before. Throws WindowError if refused.
    void resize(int width_px, int height_px, int samples, bool depth);
    void bind() const;
    /// Copies colour, scaled if the sizes differ (not with samples on either side).
    void blit_to(const Target& to) const;
    void blit_to_window(int width_px, int height_px) const;
    int width_px() const noexcept { return width_px_; }
    int height_px() const noexcept { return height_px_; }
    GLuint frame_id() const noexcept { return frame_.id(); }
    GLuint texture_id() const noexcept { return picture_.id(); } // smooth, not repeating

  private:
    Name<ReleaseFrame> frame_;
    Name<ReleaseStore> colour_, depth_;
    Texture picture_;
    int width_px_ = 0, height_px_ = 0, samples_ = 0;
};

} // namespace view

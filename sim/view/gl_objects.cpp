// sim/view/gl_objects.cpp
// Making, compiling, resizing of what gl_objects.h owns.
#include "sim/view/gl_objects.h"

#include "sim/view/window.h"

#include <vector>

namespace view {
namespace {

GLuint compiled(GLenum kind, const char* name, const std::string& text) {
    const GLuint shader = glCreateShader(kind);
    const char* source = text.c_str();
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint good = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good == GL_TRUE)
        return shader;
    std::vector<char> words(4096, '\0');
    glGetShaderInfoLog(shader, static_cast<GLsizei>(words.size()) - 1, nullptr, words.data());
    glDeleteShader(shader);
    throw WindowError(std::string("The graphics driver refused the shader ") + name + ": " +
                      words.data());
}

template <class Owner> Owner made(void (*make)(GLsizei, GLuint*)) {
    GLuint id = 0;
    make(1, &id);
    return Owner(id);
}

Texture picture_texture(int width_px, int height_px) {
    Texture texture = made<Texture>(glGenTextures);
    glBindTexture(GL_TEXTURE_2D, texture.id());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_px, height_px, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 nullptr);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
    for (const GLenum side : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        glTexParameteri(GL_TEXTURE_2D, side, GL_CLAMP_TO_EDGE);
    return texture;
}

} // namespace

Buffer make_buffer() {
    return made<Buffer>(glGenBuffers);
}
VertexArray make_vertex_array() {
    return made<VertexArray>(glGenVertexArrays);
}
Texture make_texture() {
    return made<Texture>(glGenTextures);
}

Program::Program(const char* name, const std::string& prelude, const char* vertex,
                 const char* fragment)
    : name_(glCreateProgram()) {
    const GLuint v = compiled(GL_VERTEX_SHADER, name, prelude + vertex);
    const GLuint f = compiled(GL_FRAGMENT_SHADER, name, prelude + fragment);
    glAttachShader(name_.id(), v);
    glAttachShader(name_.id(), f);
    glLinkProgram(name_.id());
    glDeleteShader(v);
    glDeleteShader(f);
    GLint good = GL_FALSE;
    glGetProgramiv(name_.id(), GL_LINK_STATUS, &good);
    if (good == GL_TRUE)
        return;
    std::vector<char> words(4096, '\0');
    glGetProgramInfoLog(name_.id(), static_cast<GLsizei>(words.size()) - 1, nullptr, words.data());
    throw WindowError(std::string("The graphics driver refused to link ") + name + ": " +
                      words.data());
}

void Program::set(const char* uniform, int value) const {
    glUniform1i(glGetUniformLocation(name_.id(), uniform), value);
}
void Program::set(const char* uniform, float value) const {
    glUniform1f(glGetUniformLocation(name_.id(), uniform), value);
}
void Program::set(const char* uniform, const glm::vec2& value) const {
    glUniform2fv(glGetUniformLocation(name_.id(), uniform), 1, glm::value_ptr(value));
}
void Program::set(const char* uniform, const glm::vec3& value) const {
    set(uniform, &value, 1);
}
void Program::set(const char* uniform, const glm::vec4& value) const {
    set(uniform, &value, 1);
}
void Program::set(const char* uniform, const glm::mat4& value) const {
    glUniformMatrix4fv(glGetUniformLocation(name_.id(), uniform), 1, GL_FALSE,
                       glm::value_ptr(value));
}
void Program::set(const char* uniform, const glm::vec4* values, int count) const {
    glUniform4fv(glGetUniformLocation(name_.id(), uniform), count, glm::value_ptr(*values));
}
void Program::set(const char* uniform, const glm::vec3* values, int count) const {
    glUniform3fv(glGetUniformLocation(name_.id(), uniform), count, glm::value_ptr(*values));
}

void Target::resize(int width_px, int height_px, int samples, bool depth) {
    if (width_px == width_px_ && height_px == height_px_ && samples == samples_)
        return;
    width_px_ = width_px;
    height_px_ = height_px;
    samples_ = samples;
    frame_ = made<Name<ReleaseFrame>>(glGenFramebuffers);
    glBindFramebuffer(GL_FRAMEBUFFER, frame_.id());
    if (samples > 0) {
        colour_ = made<Name<ReleaseStore>>(glGenRenderbuffers);
        glBindRenderbuffer(GL_RENDERBUFFER, colour_.id());
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, width_px, height_px);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                                  colour_.id());
    } else {
        picture_ = picture_texture(width_px, height_px);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, picture_.id(),
                               0);
    }
    if (depth) {
        depth_ = made<Name<ReleaseStore>>(glGenRenderbuffers);
        glBindRenderbuffer(GL_RENDERBUFFER, depth_.id());
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT24, width_px,
                                         height_px);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                  depth_.id());
    }
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw WindowError("The graphics driver has no room for a picture of " +
                          std::to_string(width_px) + " x " + std::to_string(height_px) +
                          " pixels: use a smaller window.");
}

void Target::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, frame_.id());
    glViewport(0, 0, width_px_, height_px_);
}

void Target::blit_to(const Target& to) const {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_.id());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to.frame_.id());
    const bool same = width_px_ == to.width_px_ && height_px_ == to.height_px_;
    glBlitFramebuffer(0, 0, width_px_, height_px_, 0, 0, to.width_px_, to.height_px_,
                      GL_COLOR_BUFFER_BIT, same ? GL_NEAREST : GL_LINEAR);
}

void Target::blit_to_window(int width_px, int height_px) const {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_.id());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, width_px_, height_px_, 0, 0, width_px, height_px, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
}

} // namespace view

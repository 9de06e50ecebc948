// sim/view/shaders.h
// The shader texts, GLSL 3.30. Compiled once by picture.cpp and optics.cpp in the render
// thread.
#pragma once

namespace view::shaders {

extern const char* const prelude; // version, the lamp and the tone curve: before every shader
extern const char* const tissue_vertex;
extern const char* const tissue_fragment; // with FINE: two scales; with NEAR: tools' shadows
extern const char* const tool_vertex;
extern const char* const tool_fragment;
extern const char* const target_vertex;
extern const char* const target_fragment;
extern const char* const path_vertex;
extern const char* const path_fragment;
extern const char* const lens_vertex; // these two want no prelude but a version
extern const char* const lens_fragment;

} // namespace view::shaders

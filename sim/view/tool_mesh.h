// sim/view/tool_mesh.h
// An instrument as a few stretched cylinders and spheres. Pure geometry; any thread.
#pragma once

#include "sim/view/frame.h"

#include <vector>

#include <glm/mat4x4.hpp>

namespace view {

struct ToolPart {
    enum class Form { cylinder, ball } form = Form::cylinder; // unit radius; cylinder z 0..1
    glm::mat4 model{1.0F};
    glm::vec3 base{0.5F}; // linear colour
    float metal = 0.0F;
};

/// Shaft, insulation, role ring and two jaws. The closed jaws end where the tip sphere does.
std::vector<ToolPart> tool_parts(const ToolView& tool);

/// The role's colour, sRGB 0..1; told apart also by colour-blind eyes (Okabe and Ito 2008).
glm::vec3 role_colour(Role role) noexcept;

} // namespace view

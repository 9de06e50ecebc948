// sim/view/tissue_style.h
// Colours and pattern of each look. Pure; read by the picture in the render thread.
#pragma once

#include "sim/view/tissue_look.h"

#include <glm/vec3.hpp>

namespace view {

/// Colours are linear light. A tile of noise repeats every 1/tiles metres.
struct TissueStyle {
    glm::vec3 deep{0.0F}, pale{0.0F}; // ends of the mottle
    glm::vec3 vein{0.0F};
    float coarse_tiles_1pm = 5.0F; // lobes, large vessels
    float fine_tiles_1pm = 29.0F;  // lobules, small vessels; 0: none, which is quicker
    float fine_share = 0.4F;       // of the mottle, 0..1
    float veins = 0.0F;            // how plain large vessels are, 0..1
    float small_veins = 0.0F;
    float wet = 0.5F;   // strength of the highlights
    float bumps = 0.5F; // how much the film's waves turn them
};

const TissueStyle& style_of(Look look) noexcept;

} // namespace view

// sim/view/optics.cpp
#include "sim/view/optics.h"

#include "sim/view/shaders.h"

namespace view {

Optics::Optics()
    : program_("lens", "#version 330 core\n", shaders::lens_vertex, shaders::lens_fragment),
      triangle_(make_vertex_array()) {}

void Optics::draw(const Target& pinhole, const Lens& lens, double aspect) const {
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_SCISSOR_TEST);
    program_.use();
    program_.set("aspect", static_cast<float>(aspect));
    program_.set("rim", static_cast<float>(lens.rim));
    program_.set("barrel", static_cast<float>(lens.barrel));
    program_.set("reach", glm::vec2(lens.reach));
    program_.set("pinhole", 0);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, pinhole.texture_id());
    glBindVertexArray(triangle_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
}

} // namespace view

// sim/view/optics.h
// The last pass over the picture: the endoscope's lens with its round rim. Called by Window, in the
// render thread.
#pragma once

#include "sim/view/gl_objects.h"
#include "sim/view/lens.h"

namespace view {

class Optics {
  public:
    Optics();
    /// The pinhole's picture through the lens into the bound target, all of it.
    void draw(const Target& pinhole, const Lens& lens, double aspect) const;

  private:
    Program program_;
    VertexArray triangle_; // no attributes: corners come from gl_VertexID
};

} // namespace view

// assets/bake/import/winding.h
// How often a surface winds around a point: 1 inside, 0 outside, between where it has holes
// (Jacobson, Kavan & Sorkine-Hornung 2013), and for many points the far triangles of a tree taken
// together as dipoles (Barill, Dickson, Schmidt, Levin & Jacobson 2018). Called by bodies and
// resample.
#pragma once

#include "assets/bake/import/box_tree.h"

namespace bake {

/// Sum over all triangles; exact but for rounding.
double winding_number(const Surface& surface, const glm::dvec3& p);

class FastWinding {
  public:
    /// `surface` must outlive it and not change.
    explicit FastWinding(const Surface& surface);
    [[nodiscard]] double operator()(const glm::dvec3& p) const;

  private:
    struct Dipole {
        glm::dvec3 centre_m{0.0}, area_m2{0.0};
        double radius_m = 0.0;
    };
    const Surface& surface_;
    BoxTree tree_;
    std::vector<Dipole> dipole_; // of every node
};

} // namespace bake

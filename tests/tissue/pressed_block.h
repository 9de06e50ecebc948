// tests/tissue/pressed_block.h
// A clamped block pressed by a spherical tip, in statics, put together as a scene does it: rows on
// corotated or quadratic tetrahedra, mesh term, sub-grid term. Against what a block should answer:
// W = (1-nu^2)/(2 E a) + W_reg, where W_reg (what the block's size does, no tip in it) was computed
// on 27-node hexahedra, 22 x 22 x 11, with kernels of 6, 8 and 10 mm extrapolated to a point.
#pragma once

#include "tissue/mesh/contact_surface.h"
#include "tissue/response/subgrid.h"
#include "tissue/solver/sparse_factor.h"

#include <cstddef>
#include <optional>

namespace block {

inline constexpr double kYoung_pa = 6e3;
inline constexpr double kPoisson = 0.45;

/// What to leave out: the negative controls.
struct Parts {
    bool mesh_term = true;
    bool subgrid = true;
    bool layer = true; // false: the sub-grid term of a half-space
};

class PressedBlock {
  public:
    PressedBlock(tissue::TetMesh mesh, std::vector<std::uint8_t> anchored,
                 tissue::ContactSurface skin, int order = 1);

    /// m/N along `axis` at a place on top, for a flat tip of radius a.
    double compliance_mpn(double x_m, double y_m, int axis, double tip_radius_m,
                          const Parts& parts = {}) const;
    double stiffness_npm(double x_m, double y_m, int axis, double a_m, const Parts& p = {}) const {
        return 1.0 / compliance_mpn(x_m, y_m, axis, a_m, p);
    }

    /// Force of a sphere pressed to `depth_m`, by bisection on d(P) = D(P) + P (far part).
    double force_n(double x_m, double y_m, double depth_m, const tissue::SphereLaw& law,
                   double tip_radius_m) const;
    double depth_m(double x_m, double y_m, double force_n, const tissue::SphereLaw& law,
                   double tip_radius_m) const;

    const tissue::TetMesh& mesh() const { return mesh_; }
    const tissue::ContactSurface& skin() const { return skin_; }

  private:
    struct Contact { // of three skin vertices
        std::array<std::uint32_t, 3> vertex{};
        glm::dvec3 weight{0.0};
    };
    Contact find(double x_m, double y_m) const;
    double mesh_mpn(const Contact& at, int axis) const;
    double mix(const Contact& at, const std::vector<double>& value) const;

    double far_mpn(const Contact& at, double thick_m) const;         // all but the sphere's own law
    double punch_mpn(double tip_radius_m, double thickness_m) const; // remembers the last

    void find_flexibility(std::span<const std::int32_t> dof, tissue::SparseFactor& factor,
                          double scale);

    tissue::TetMesh mesh_;
    tissue::ContactSurface skin_;
    std::vector<std::int32_t> slot_;                     // of a node in the table below; -1
    std::array<std::vector<double>, 3> flexibility_mpn_; // per axis, slots x slots
    std::size_t slots_ = 0;
    mutable std::array<double, 3> punch_{};
};

/// A box of (Kuhn) tets with rows and mesh terms on its whole top.
PressedBlock pressed_box(const glm::dvec3& size_m, const std::array<int, 3>& cells,
                         double tip_radius_max_m = 5e-3, bool point_rows = false);

/// The same on quadratic shapes, whose interior nodes may stand off the grid by `jitter` cells.
PressedBlock quadratic_box(const glm::dvec3& size_m, const std::array<int, 3>& cells,
                           double jitter = 0.0, bool point_rows = false,
                           double tip_radius_max_m = 5e-3);

/// W_reg of the 80x80x40 block, m/N: -1.57 mm/N (normal) and +1.2 (tangential) at the centre,
/// -0.65 and +4.4 at (20, 20) mm; parabolas between.
double regular_mpn(double x_m, double y_m, int axis);
double reference_stiffness_npm(double x_m, double y_m, int axis, double tip_radius_m);

struct Spread {
    double mean, deviation, low, high; // of K / K_ref
};
/// Over 50 places in [20, 60]^2 mm, seed 1.
Spread spread(const PressedBlock& pressed, int axis, double tip_radius_m, const Parts& parts = {});

/// Largest step of K / mean K between places 0.05 mm apart on 30 mm at 17 degrees.
double worst_slide_step(const PressedBlock& pressed, int axis, double tip_radius_m,
                        const Parts& parts = {});

/// Largest force step, N, on the same way at a depth.
double worst_force_step_n(const PressedBlock& pressed, double depth_m, const tissue::SphereLaw& law,
                          double tip_radius_m);

} // namespace block

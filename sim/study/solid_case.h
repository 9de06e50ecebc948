// sim/study/solid_case.h
// The solids that tissue methods are measured on: a clamped bar, a block pressed from above, Cook's
// membrane; regular grids, six tets a cell. What is asked (SolidCase) and the meshes, anchors and
// loads that follow from it (SolidBody), the same for every model. Called by studies; any thread.
//   x along the length, y up, z across; gravity in -y
//   bar       clamped at x = 0, pulled in -y at x = length
//   block     clamped at y = 0, pressed in -y on the middle of its top
//   membrane  corners (0,0) (L,H) (L,60H/44) (0,H), clamped at x = 0, pulled in +y at x = L (Cook
//             1974: L = 48, H = 44)
#pragma once

#include "tissue/material/elastic.h"
#include "tissue/mesh/quadratic_mesh.h"

#include <string>

namespace sim {

enum class SolidShape { bar, block, membrane };
enum class SolidElement { linear, quadratic }; // four nodes, ten nodes
enum class SolidPress { pressure, punch };     // a uniform dead load; a glued plate

struct SolidCase {
    SolidShape shape = SolidShape::bar;
    double length_m = 0.2, height_m = 0.04, width_m = 0.04; // x, y, z
    std::array<int, 3> cells{10, 2, 2};                     // along x, y, z
    tissue::Material material{.young_pa = 100e3,
                              .poisson = 0.45,
                              .density_kgpm3 = 1000.0,
                              .damping_mass_1ps = 0.0,
                              .damping_stiffness_s = 0.0,
                              .source = "study"};
    double gravity_mps2 = 9.81;
    std::vector<double> load_n{0.0}; // in all, along load_direction(); one after the other
    SolidPress press = SolidPress::pressure;
    double patch_m = 0.0;          // side of the square that is pressed; 0: the whole top
    std::vector<double> depth_m{}; // of the punch, one after the other
    std::string model = "quadratic";
    std::string element{}; // p1, p2; empty: the model's own
    double dt_s = 0.01;
    int steps = 200;
    bool statics = false;
};

/// Models by name: linear corotated quadratic reference mass-spring xpbd tled projective.
std::span<const char* const> solid_models();

/// Throws std::invalid_argument naming the option, its value and what would be accepted.
void check(const SolidCase& work);

/// Of the model, or what `element` says. Throws as check().
SolidElement element_of(const SolidCase& work);

struct SolidBody {
    tissue::TetMesh corners;
    tissue::QuadraticMesh quadratic; // empty for linear elements
    std::vector<glm::dvec3> rest_m;  // of the nodes of the element; below, one entry per node
    std::vector<std::uint8_t> clamped;
    std::vector<std::uint8_t> punched; // goes with the punch; empty: there is none
    std::vector<double> load_share;    // of a uniform traction, sums to 1; for its mean way too
    glm::dvec3 load_direction{0.0, -1.0, 0.0};
    std::vector<std::pair<std::uint32_t, double>> tip; // node, weight: middle of the loaded face

    std::size_t tets() const { return corners.tets.size(); }
};

/// Throws as check().
SolidBody make_solid_body(const SolidCase& work);

/// Displacement of the middle of the loaded face, and the mean over the face.
glm::dvec3 tip_of(const SolidBody& body, std::span<const glm::dvec3> position_m);
glm::dvec3 mean_of(const SolidBody& body, std::span<const glm::dvec3> position_m);

/// "10x2x2". Throws std::invalid_argument for anything else.
std::array<int, 3> cells_of(const std::string& text);
std::string cells_name(const std::array<int, 3>& cells);

} // namespace sim

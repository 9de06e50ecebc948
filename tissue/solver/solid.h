// tissue/solver/solid.h
// A deforming body of any tier, in the pieces of a step between which sim/ puts the contact solve:
//   free_motion under the load of before -> solve the rows of the contact ->
//   du += A^-1 H^T (F - F before) -> end_step
// Near enough serves as A^-1 there: where the load stays, it plays no part.
// Tissue loop; bodies are made at setup.
//
//   linear     linear tetrahedra about the rest shape: one matrix, factored once. Cheap; what turns
//              swells (Mueller & Gross 2004), so for a gentle touch only.
//   corotated  linear tetrahedra that turn, tissue/solver/corotated.h. Locks where it bends and
//              towards nu = 0.5.
//   quadratic  ten-node neo-Hooke, tissue/solver/quadratic.h. Does not lock.
// A tube is a rod in each of them (rod_solid.h); its "nodes" below are the points of its skin.
#pragma once

#include "tissue/solver/chord.h"
#include "tissue/solver/descent.h"
#include "tissue/solver/quadratic_refactor.h"
#include "tissue/solver/rod_solid.h"

#include <memory>
#include <optional>
#include <string_view>
#include <variant>

namespace tissue {

/// Cheapest first. `rigid` has no Solid.
enum class Tier : std::uint8_t { rigid, linear, corotated, quadratic };
inline constexpr std::array<std::string_view, 4> kTierNames{"rigid", "linear-compliance",
                                                            "corotated", "quadratic"};
inline std::string_view name_of(Tier tier) noexcept {
    return kTierNames[static_cast<std::size_t>(tier)];
}
std::optional<Tier> tier_named(std::string_view name) noexcept;

/// Tiers linear and corotated.
struct CorotatedSolid {
    CorotatedModel model;
    CorotatedState state;
    CorotatedSystem system; // linearised at `state`, or near it
    Descent descent;        // for steps that one Newton iteration does not do
    Chord chord;            // for steps that the tangent of before does
    bool linear = false;    // the tangent of the rest shape for ever
    double drift_m = 0.0;   // how far anything moved since the system was linearised
};

struct QuadraticSolid {
    QuadraticModel model;
    QuadraticState state;
    QuadraticSystem system;
    QuadraticOptions options;
    int most_iterations = 0; // of the linear solves of this step
    int factor_steps = 2;    // from the begin of a new factor to its use
    int since_factor = 0;    // steps since the preconditioner began to be factored anew
    std::unique_ptr<Refactoring> refactoring;
    bool begun = false;   // linearised for the step that is being made
    double drift_m = 0.0; // how far anything moved since its tangent was said to be new
};

struct RodSolid {
    RodBody model;
    RodState state;
    RodSystem system;
    RodPoints points;
    Tier tier = Tier::linear; // that was asked for
    double drift_m = 0.0;     // as above
};

using Solid = std::variant<CorotatedSolid, QuadraticSolid, RodSolid>;

/// What is made of an organ: linear tetrahedra, which nodes are fixed, what holds the rest; or the
/// line of a tube and its skin.
struct SolidMesh {
    const TetMesh& mesh;
    std::span<const std::uint8_t> anchored{}; // a byte per node; may be empty
    std::span<const BedSample> bed{};         // may be empty
    const RodLine* line = nullptr;            // if any, instead of the tetrahedra
    std::span<const glm::dvec3> skin_m{};     // of a tube
};

/// The corners of quadratic tetrahedra keep their numbers, mid-edge nodes follow (quadratic_mesh.h)
/// and are fixed where both ends are. Throws as make_corotated(), make_quadratic(), make_rod() do,
/// and std::invalid_argument for the rigid tier or a step that is not above 0. An infinite one is
/// that of statics, which quadratic bodies refuse.
Solid make_solid(Tier tier, const SolidMesh& mesh, const Material& material,
                 const glm::dvec3& gravity_mps2, double dt_s);

Tier tier_of(const Solid& solid) noexcept;
int unknowns(const Solid& solid) noexcept;
const Material& material_of(const Solid& solid) noexcept;
/// Of each node, the first of its 3 unknowns; -1: anchored.
std::span<const std::int32_t> dofs(const Solid& solid) noexcept;
std::span<const glm::dvec3> rest_m(const Solid& solid) noexcept;
std::span<const glm::dvec3> position_m(const Solid& solid) noexcept;

/// What a step had to do, of one body.
struct SolidReport {
    // |A x - b|, the worst: of |b|; of Newton's steps, of all forces as `residual`
    double linear_residual = 0.0;
    // quadratic: nonlinear, as QuadraticReport; corotated: of a descent, as StepEnd
    double residual = 0.0;
    int iterations = 0;       // Newton's, beyond the first of a step; 0: one was enough
    int inverted = 0;         // tets, or 1 if a quadratic body recovers
    bool warped = false;      // fell back to another tangent than the exact one
    bool new_tangent = false; // what rests on the one of before is old
};

/// The motion that the body would make under a load, on the unknowns. `touched`: the load will
/// change: then only what one linearisation says, which the contact is added to. `load_n`: may be
/// empty, as in end_step().
SolidReport free_motion(Solid& solid, bool touched, std::span<const double> load_n,
                        std::span<double> du) noexcept;

/// A x = b in place for `columns` right-hand sides, stored one after another, to the relative
/// residual `tolerance` where they are solved by iteration; that starts from `first`, as `block`,
/// if it is not empty. Returns the worst, 0 for a direct solve.
double solve(Solid& solid, double tolerance, std::span<const double> first, std::span<double> block,
             int columns) noexcept;

/// Moves by `du`, corrected for the forces there. The tangent stays while nothing has drifted
/// farther than `relinearise_m`, of corotated bodies while it corrects well (chord.h); 0: never.
/// `load_n`: of the contact, on the unknowns. `placed`: contact has placed the skin, and no
/// correction may move it again; what is left over drives the next step, as in linearly implicit
/// integration (Baraff & Witkin, SIGGRAPH 1998).
SolidReport end_step(Solid& solid, std::span<const double> load_n, double relinearise_m,
                     std::span<double> du, bool placed = false) noexcept;

/// Stops where it is.
void stop(Solid& solid) noexcept;

/// Peak von Mises stress at the last linearisation, Pa.
double peak_von_mises_pa(const Solid& solid) noexcept;

/// Elastic energy, of the bed too.
double elastic_energy_j(const Solid& solid) noexcept;

} // namespace tissue

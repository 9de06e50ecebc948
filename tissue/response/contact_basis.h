// tissue/response/contact_basis.h
// The few modes with which tissue answers at 1 kHz: moment-matched to the loads the tools may
// apply before the next FEM answer (own directions with two or three moments, and a star of
// neighbouring contact points, because the contact slides before the answer is used).
//   B1 = A^-1 [n t1 t2 at c | n at c +- delta t1, c +- delta t2]
//   B2 = A^-1 M B1(n t1 t2 at c),  B3 = A^-1 M B2(n at c)
// A point that jaws hold stays where it is: more moments of it instead of the star,
//   B1 = A^-1 [t1 t2 n at c], B2, B3, B4 = A^-1 M B3(t1 t2 at c)
//   V: M-orthonormal, Lambda = V^T K V diagonal
// A is the FEM step's: the modes are exact for what a load has done after one such step, good for
// the few steps that an answer lives, and too stiff at rest where the body as a whole sways more
// slowly (liver: 4 to 10 Hz). Modes of K would be exact at rest and wrong when they are used; the
// numbers are in tests/sim/grasp_compliance_test.cpp.
#pragma once

#include "tissue/response/contact_rows.h"
#include "tissue/solver/corotated.h"
#include "tissue/solver/quadratic.h"

namespace tissue {

inline constexpr int kModesPerContact = 11;
inline constexpr int kMaxContacts = 3;
inline constexpr int kMaxBasis = kModesPerContact * kMaxContacts;

/// Whether the columns of a contact from before serve. `about`: only as what later moments rest on,
/// so that all are solved for at once. `space`: of a corotated body, solved for with
/// another factor: as columns of a basis they serve, what A makes of them is found anew. `all`: as
/// they are, of a corotated body with the same factor.
enum class KeptColumns : std::uint8_t { none, about, space, all };
/// Whether the columns of a contact are not solved for.
constexpr bool serve(KeptColumns kept) noexcept {
    return kept >= KeptColumns::space;
}

struct BasisContact {
    ContactPoint centre;
    std::array<ContactPoint, 4> star; // c +- delta t1, c +- delta t2
    glm::dvec3 normal, tangent1, tangent2;
    bool held = false; // by jaws; `star` means nothing then
    int slot = -1;     // 0 to 2, where its columns are kept; -1: its place in the list
    KeptColumns kept = KeptColumns::none; // there, with the same `held`
};

/// Buffers sized once; contents mean nothing between calls except as output.
struct ContactBasis {
    int modes = 0;
    std::vector<double> shape;                // unknowns x modes, one mode after the other
    std::array<double, kMaxBasis> lambda{};   // 1/s^2, ascending
    std::array<double, kMaxBasis> residual{}; // V^T (f_int - f_ext)
    std::array<double, kMaxBasis> rate{};     // V^T M v
    std::vector<double> work;
    int solved = 0; // columns that the last call solved for
    // by slot and moment: as they were solved for, of unit M-norm, and of a quadratic body M times
    // them, of a corotated one their loads
    std::vector<double> column, mass_column;
};
ContactBasis make_contact_basis(int unknowns);

/// Fills `basis` for up to three contacts on one body. `system` must be made at `state`; if it
/// could not be factored, or there is no contact, the basis has no modes.
/// Directions that are already in the basis (relative size below 1e-6) are dropped. No allocation
/// outside CHOLMOD.
void compute_contact_basis(const CorotatedModel& model, const ContactSurface& surface,
                           const CorotatedState& state, CorotatedSystem& system,
                           std::span<const BasisContact> contacts, ContactBasis& basis) noexcept;

/// The same modes at a later state of the same factor: only residual and rate are new.
void refresh_contact_basis(const CorotatedModel& model, const CorotatedState& state,
                           const CorotatedSystem& system, ContactBasis& basis) noexcept;

/// For a quadratic body after a step. Its columns are solved for roughly and projected exactly: as
/// a Galerkin basis any columns serve, and an error of the columns counts squared. `system` then
/// remembers the modes, and its solves start from them; without contacts it forgets them. Solves
/// are for contacts whose columns are not kept: one costs a third of three, or of one without any.
void compute_contact_basis(const QuadraticModel& model, const ContactSurface& surface,
                           const QuadraticState& state, QuadraticSystem& system,
                           std::span<const BasisContact> contacts, ContactBasis& basis) noexcept;
/// The space of before under the tangent of now: no solve, new modes and frequencies in it.
void follow_contact_basis(const QuadraticModel& model, const QuadraticState& state,
                          QuadraticSystem& system, ContactBasis& basis) noexcept;
void refresh_contact_basis(const QuadraticModel& model, const QuadraticState& state,
                           QuadraticSystem& system, ContactBasis& basis) noexcept;

} // namespace tissue

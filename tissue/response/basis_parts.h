// tissue/response/basis_parts.h
// What the bases of all solvers share: which loads make the modes, and the dense algebra over tall
// columns of unknowns. Internal to tissue/response; tissue loop, no allocation.
#pragma once

#include "tissue/response/contact_basis.h"
#include "tissue/response/small_eigen.h"

namespace tissue {

inline constexpr double kBasisCut = 1e-6; // relative size below which a direction is there already
static_assert(kMaxBasis <= kSmall);

// Columns of a contact, moment by moment; the first of one moment make those of the next.
inline constexpr int kMoments = 4;
inline constexpr std::array<int, kMoments> kFree{7, 3, 1, 0}; // n t1 t2 and the star, n t1 t2, n
inline constexpr std::array<int, kMoments> kHeldMoments{3, 3, 3, 2}; // t1 t2 n thrice, t1 t2
static_assert(7 + 3 + 1 == kModesPerContact && 3 + 3 + 3 + 2 == kModesPerContact);

inline int columns_of(const BasisContact& contact, int moment) noexcept {
    return (contact.held ? kHeldMoments : kFree)[moment];
}
/// The first column of a moment among those of its contact.
inline int first_of(bool held, int moment) noexcept {
    int first = 0;
    for (int m = 0; m < moment; ++m)
        first += (held ? kHeldMoments : kFree)[m];
    return first;
}

/// Where a contact's columns are kept, and where one of them begins among the numbers of all.
inline int slot_of(std::span<const BasisContact> contacts, std::size_t c) noexcept {
    return contacts[c].slot < 0 ? static_cast<int>(c) : contacts[c].slot;
}
inline std::size_t kept_at(std::span<const BasisContact> contacts, std::size_t c, int column,
                           std::size_t n) noexcept {
    return static_cast<std::size_t>(slot_of(contacts, c) * kModesPerContact + column) * n;
}

struct Columns {
    double* at;
    std::size_t n;
    double* operator[](int j) const noexcept { return at + static_cast<std::size_t>(j) * n; }
    std::span<double> range(int first, int count) const noexcept {
        return {(*this)[first], static_cast<std::size_t>(count) * n};
    }
};

/// The loads of one contact's first moment: three at its centre, then, if it is not held, the
/// star's four; the k-th of these.
inline constexpr int kCentreLoads = 3, kStarLoads = 4;
static_assert(kFree[0] == kCentreLoads + kStarLoads && kHeldMoments[0] == kCentreLoads);
void load_centre(Dofs dofs, const ContactSurface& surface, const BasisContact& contact, int k,
                 std::span<double> load) noexcept;
void load_star(Dofs dofs, const ContactSurface& surface, const BasisContact& contact, int k,
               std::span<double> load) noexcept;

/// Lower triangle of a^T b, symmetric but for roundoff.
void inner_products(const double* a, const double* b, std::size_t n, int columns,
                    SmallMatrix& out) noexcept;

/// q <- q L^-T
void divide(const SmallMatrix& lower, double* q, std::size_t n, int columns) noexcept;

/// out = q * turn
void turn_columns(const double* q, const SmallMatrix& turn, std::size_t n, int columns,
                  double* out) noexcept;

/// V^T x for the modes of `basis`.
void coefficients(const ContactBasis& basis, std::span<const double> x,
                  std::array<double, kMaxBasis>& out) noexcept;

} // namespace tissue

// See the header.
#include "tissue/response/basis_parts.h"

#include <algorithm>
#include <cblas.h>

namespace tissue {

void load_centre(Dofs dofs, const ContactSurface& surface, const BasisContact& contact, int k,
                 std::span<double> load) noexcept {
    const std::array<glm::dvec3, kCentreLoads> free{contact.normal, contact.tangent1,
                                                    contact.tangent2},
        held{contact.tangent1, contact.tangent2, contact.normal};
    std::fill(load.begin(), load.end(), 0.0);
    add_row(dofs, surface, contact.centre, (contact.held ? held : free)[k], 1.0, load);
}

void load_star(Dofs dofs, const ContactSurface& surface, const BasisContact& contact, int k,
               std::span<double> load) noexcept {
    std::fill(load.begin(), load.end(), 0.0);
    add_row(dofs, surface, contact.star[k], contact.normal, 1.0, load);
}

void inner_products(const double* a, const double* b, std::size_t n, int columns,
                    SmallMatrix& out) noexcept {
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, columns, columns, static_cast<int>(n), 1.0,
                a, static_cast<int>(n), b, static_cast<int>(n), 0.0, out.data(), kSmall);
}

void divide(const SmallMatrix& lower, double* q, std::size_t n, int columns) noexcept {
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit,
                static_cast<int>(n), columns, 1.0, lower.data(), kSmall, q, static_cast<int>(n));
}

void turn_columns(const double* q, const SmallMatrix& turn, std::size_t n, int columns,
                  double* out) noexcept {
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, static_cast<int>(n), columns, columns,
                1.0, q, static_cast<int>(n), turn.data(), kSmall, 0.0, out, static_cast<int>(n));
}

void coefficients(const ContactBasis& basis, std::span<const double> x,
                  std::array<double, kMaxBasis>& out) noexcept {
    const int n = static_cast<int>(x.size());
    cblas_dgemv(CblasColMajor, CblasTrans, n, basis.modes, 1.0, basis.shape.data(), n, x.data(), 1,
                0.0, out.data(), 1);
}

} // namespace tissue

// tissue/solver/polar_rotation.cpp
// The safe path of the nearest rotation: inverted, flat and degenerate tets. Tissue loop.
#include "tissue/solver/polar_rotation.h"

#include <array>

namespace tissue {
namespace {

using Matrix4 = std::array<std::array<double, 4>, 4>;

// One Jacobi rotation that zeroes a[p][q]; `v` collects the eigenvectors in its columns
// (Golub & Van Loan, section 8.5).
void rotate(Matrix4& a, Matrix4& v, int p, int q) noexcept {
    if (a[p][q] == 0.0)
        return;
    const double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
    const double c = 1.0 / std::hypot(t, 1.0), s = t * c;
    for (int k = 0; k < 4; ++k) {
        const double akp = a[k][p], akq = a[k][q];
        a[k][p] = c * akp - s * akq;
        a[k][q] = s * akp + c * akq;
    }
    for (int k = 0; k < 4; ++k) {
        const double apk = a[p][k], aqk = a[q][k];
        a[p][k] = c * apk - s * aqk;
        a[q][k] = s * apk + c * aqk;
        const double vkp = v[k][p], vkq = v[k][q];
        v[k][p] = c * vkp - s * vkq;
        v[k][q] = s * vkp + c * vkq;
    }
}

} // namespace

glm::dmat3 closest_rotation(const glm::dmat3& F) noexcept {
    constexpr int kSweeps = 12; // quadratic convergence: 5 suffice for 4x4
    const double xx = F[0][0], xy = F[1][0], xz = F[2][0]; // row, column
    const double yx = F[0][1], yy = F[1][1], yz = F[2][1];
    const double zx = F[0][2], zy = F[1][2], zz = F[2][2];
    // tr(R(q)^T F) = q^T N q
    Matrix4 n{{{xx + yy + zz, zy - yz, xz - zx, yx - xy},
               {zy - yz, xx - yy - zz, xy + yx, zx + xz},
               {xz - zx, xy + yx, yy - xx - zz, yz + zy},
               {yx - xy, zx + xz, yz + zy, zz - xx - yy}}};
    Matrix4 v{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (int p = 0; p < 3; ++p) {
            for (int q = p + 1; q < 4; ++q)
                rotate(n, v, p, q);
        }
    }
    int best = 0;
    for (int k = 1; k < 4; ++k) {
        if (n[k][k] > n[best][best])
            best = k;
    }
    double w = v[0][best], x = v[1][best], y = v[2][best], z = v[3][best];
    const double size = std::sqrt(w * w + x * x + y * y + z * z);
    w /= size, x /= size, y /= size, z /= size;
    return {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
            {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
            {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

} // namespace tissue

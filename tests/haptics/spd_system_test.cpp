#include "haptics/rigid/spd_system.h"

#include "tests/haptics/convex_pieces.h"

#include <cmath>
#include <doctest/doctest.h>
#include <limits>

namespace {

// Q D Q^T with Q a product of plane rotations.
haptics::Matrix6 with_eigenvalues(const std::array<double, 6>& value, RandomPieces& random) {
    haptics::Matrix6 m{};
    for (std::size_t i = 0; i < 6; ++i)
        m[i][i] = value[i];
    for (std::size_t p = 0; p < 6; ++p)
        for (std::size_t q = p + 1; q < 6; ++q) {
            const double angle = random.number(0, 6.28), c = std::cos(angle), s = std::sin(angle);
            for (auto& row : m) {
                const double x = row[p], y = row[q];
                row[p] = c * x - s * y;
                row[q] = s * x + c * y;
            }
            for (std::size_t k = 0; k < 6; ++k) {
                const double x = m[p][k], y = m[q][k];
                m[p][k] = c * x - s * y;
                m[q][k] = s * x + c * y;
            }
        }
    return m;
}

} // namespace

TEST_CASE("spd system: the largest eigenvalue is the one put in") {
    RandomPieces random(40);
    for (const auto& value : {std::array<double, 6>{1, 2, 3, 4, 5, 6},
                              std::array<double, 6>{1e3, 1e3, 1e3, 1e-3, 1e-2, 0},
                              std::array<double, 6>{0, 0, 0, 0, 0, 0}}) {
        const double most = *std::max_element(value.begin(), value.end());
        CHECK(std::abs(haptics::largest_eigenvalue(with_eigenvalues(value, random)) - most) <=
              1e-14 * most);
    }
}

TEST_CASE("spd system: what is solved fulfils the equations; what has no solution says so") {
    RandomPieces random(41);
    haptics::SpdSystem system;
    system.n = 6;
    const haptics::Matrix6 m = with_eigenvalues({1e-2, 1, 2, 30, 500, 1e4}, random);
    std::array<double, 6> x{1, -2, 3, -4, 5, -6};
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j) {
            system.a[i][j] = m[i][j];
            system.b[i] += m[i][j] * x[j];
        }
    haptics::SpdSystem broken = system, indefinite = system;
    REQUIRE(haptics::solve(system));
    for (std::size_t i = 0; i < 6; ++i)
        CHECK(system.b[i] == doctest::Approx(x[i]).scale(0.0).epsilon(1e-9));
    broken.b[3] = std::numeric_limits<double>::quiet_NaN();
    CHECK(!haptics::solve(broken));
    indefinite.a[5][5] = -1.0;
    CHECK(!haptics::solve(indefinite));
}

// tests/tissue/mode_shapes_test.cpp
// The fast way to the modes of a skin vertex against the plain one, mode by mode.
#include "tissue/response/mode_shapes.h"

#include "tests/tissue/touched_body.h"

#include <doctest/doctest.h>
#include <random>

TEST_CASE("mode shapes: every vertex moves per mode as its footprint row says") {
    const bodies::TouchedBlock block = bodies::touched_block({4, 4, 2}, bodies::elastic(8e3, 0.45));
    const int n = block.model.unknowns;
    constexpr int kModes = 7;
    tissue::ContactBasis basis = tissue::make_contact_basis(block.model.unknowns);
    basis.modes = kModes;
    std::mt19937_64 random(5);
    for (int i = 0; i < n * kModes; ++i)
        basis.shape[i] = static_cast<double>(random() % 2001) * 1e-3 - 1.0;
    std::vector<double> by_unknown(n * kModes);
    tissue::turn_shapes(basis, n, by_unknown);
    std::array<std::array<double, kModes>, 3> shape;
    for (std::uint32_t v = 0; v < block.skin.rest_m.size(); ++v) {
        tissue::vertex_shapes(block.model.dof, block.skin, v, by_unknown, kModes,
                              {shape[0].data(), shape[1].data(), shape[2].data()});
        for (int m = 0; m < kModes; ++m) {
            const glm::dvec3 plain =
                tissue::vertex_value(block.model.dof, block.skin, v,
                                     std::span<const double>(basis.shape).subspan(m * n, n));
            for (int axis = 0; axis < 3; ++axis)
                CHECK(std::abs(shape[axis][m] - plain[axis]) < 1e-13);
        }
    }
}

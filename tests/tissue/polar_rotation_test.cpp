// tests/tissue/polar_rotation_test.cpp
#include "tissue/solver/polar_rotation.h"

#include "tests/tissue/bodies.h"

#include <doctest/doctest.h>
#include <glm/matrix.hpp>

using glm::dmat3;
using glm::dvec3;

namespace {

dmat3 diagonal(double a, double b, double c) {
    return {{a, 0, 0}, {0, b, 0}, {0, 0, c}};
}

double distance(const dmat3& a, const dmat3& b) {
    return std::max({glm::length(a[0] - b[0]), glm::length(a[1] - b[1]), glm::length(a[2] - b[2])});
}

dmat3 random_rotation(std::mt19937_64& random) {
    const dvec3 axis = bodies::signed_vector(random);
    return bodies::rotation(axis, 3.1 * bodies::signed_unit(random));
}

} // namespace

TEST_CASE("F = U s V^T with positive s turns by U V^T, from near rest to very flat and long") {
    std::mt19937_64 random(1);
    for (const dvec3 s :
         {dvec3(1, 1, 1), dvec3(1.1, 0.9, 1.02), dvec3(3, 0.5, 0.2), dvec3(1, 1, 0.01),
          dvec3(1, 1, 1e-5), dvec3(40, 30, 20), dvec3(2e-3, 1e-3, 3e-3), dvec3(1, 0.1, 0.01)}) {
        for (int i = 0; i < 50; ++i) {
            const dmat3 U = random_rotation(random), V = random_rotation(random);
            const dmat3 F = U * diagonal(s.x, s.y, s.z) * glm::transpose(V);
            // sensitivity of the polar factor: 2 / (smallest sum of two singular values)
            const double smallest = s.x + s.y + s.z - std::max({s.x, s.y, s.z});
            const double largest = std::max({s.x, s.y, s.z});
            CHECK(distance(tissue::polar_rotation(F), U * glm::transpose(V)) <
                  2e-14 * largest / smallest);
        }
    }
}

TEST_CASE("an inverted F takes the sign on its smallest singular value") {
    std::mt19937_64 random(2);
    for (const dvec3 s : {dvec3(1, 1, -0.5), dvec3(1.2, 0.9, -0.1), dvec3(2, 1, -0.99)}) {
        for (int i = 0; i < 50; ++i) {
            const dmat3 U = random_rotation(random), V = random_rotation(random);
            const dmat3 F = U * diagonal(s.x, s.y, s.z) * glm::transpose(V);
            const double gap = s.y + s.z;
            CHECK(distance(tissue::polar_rotation(F), U * glm::transpose(V)) < 2e-14 * s.x / gap);
        }
    }
}

TEST_CASE("a collapsed F still gives a proper rotation") {
    std::mt19937_64 random(3);
    const dvec3 a = bodies::signed_vector(random), b = bodies::signed_vector(random);
    const dmat3 line{a, 2.0 * a, -a};
    for (const dmat3& F : {dmat3(0.0), line, dmat3{a, b, a + b}, diagonal(1, 1, -1)}) {
        const dmat3 R = tissue::polar_rotation(F);
        CHECK(distance(glm::transpose(R) * R, dmat3(1.0)) < 1e-14);
        CHECK(glm::determinant(R) == doctest::Approx(1.0).scale(0.0).epsilon(1e-14));
    }
}

TEST_CASE("both ways to the rotation agree") {
    std::mt19937_64 random(4);
    for (int i = 0; i < 500; ++i) {
        const dmat3 F =
            dmat3(1.0) + 0.4 * dmat3{bodies::signed_vector(random), bodies::signed_vector(random),
                                     bodies::signed_vector(random)};
        if (glm::determinant(F) < 0.05)
            continue;
        CHECK(distance(tissue::polar_rotation(F), tissue::closest_rotation(F)) < 1e-13);
    }
}

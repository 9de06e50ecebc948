// tests/tasks/sparc_test.cpp
// SPARC against the published vector, its invariances and a closed-form spectrum.
#include "tasks/score/smoothness.h"

#include "relative.h"

#include <cmath>
#include <numbers>
#include <rapidcheck.h>

using tasks::sparc;
using tasks::testing::relative;

namespace {

// v = exp(-5 t^2) for t = -1 .. 1, n samples.
std::vector<double> bell(std::size_t n) {
    std::vector<double> speed(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double t = -1.0 + 2.0 * static_cast<double>(i) / static_cast<double>(n);
        speed[i] = std::exp(-5.0 * t * t);
    }
    return speed;
}

} // namespace

TEST_CASE("SPARC of the published test vector is -1.41403") {
    // Balasubramanian et al. 2015, reference implementation, five decimals; fs = 100 Hz
    CHECK(sparc(bell(200), 100.0).value() == relative(-1.41403, 5e-6));
}

TEST_CASE("SPARC does not depend on how fast the same movement is made") {
    // Twice as slow is the same samples at half the rate: the spectrum ends before 10 Hz in both.
    CHECK(sparc(bell(200), 50.0).value() == sparc(bell(200), 100.0).value());
}

TEST_CASE("SPARC does not depend on the sampling rate") {
    // The last bin above the threshold moves by up to one bin of 0.03 Hz in 1.2 Hz of bandwidth.
    CHECK(sparc(bell(2000), 1000.0).value() == relative(-1.41403, 0.01));
    CHECK(sparc(bell(600), 300.0).value() == relative(-1.41403, 0.01));
}

TEST_CASE("SPARC does not depend on the unit of speed, nor on the direction of time") {
    CHECK(rc::check("scale and reversal", [](std::vector<unsigned char> cells) {
        std::vector<double> speed(cells.begin(), cells.end()), scaled = speed;
        for (double& v : scaled)
            v *= 4.0;
        const auto a = sparc(speed, 1000.0), b = sparc(scaled, 1000.0);
        const auto c = sparc(std::vector<double>(speed.rbegin(), speed.rend()), 1000.0);
        RC_ASSERT(a.has_value() == b.has_value() && a.has_value() == c.has_value());
        if (a) {
            RC_ASSERT(std::abs(*a - *b) < 1e-9);
            RC_ASSERT(std::abs(*a - *c) < 1e-9);
        }
    }));
}

TEST_CASE("two peaks are less smooth than one") {
    std::vector<double> twice = bell(200);
    const std::vector<double> once = twice;
    twice.insert(twice.end(), once.begin(), once.end());
    CHECK(sparc(twice, 100.0).value() < sparc(once, 100.0).value() - 0.5);
}

TEST_CASE("SPARC of a rectangle is the arc of its closed-form spectrum") {
    // N equal samples: |V(f)|/V(0) = |sin(pi f N/fs) / (N sin(pi f/fs))|, at the same bins.
    const std::size_t n = 500, padded = 512 * 16;
    const double fs_hz = 1000.0;
    std::vector<double> share;
    for (std::size_t k = 0; static_cast<double>(k) * fs_hz / padded <= 10.0; ++k) {
        const double x = std::numbers::pi * static_cast<double>(k) / padded;
        share.push_back(k == 0 ? 1.0 : std::abs(std::sin(x * n) / (n * std::sin(x))));
    }
    while (share.back() < 0.05)
        share.pop_back();
    double arc = 0.0;
    for (std::size_t k = 1; k < share.size(); ++k)
        arc += std::hypot(1.0 / static_cast<double>(share.size() - 1), share[k] - share[k - 1]);
    CHECK(sparc(std::vector<double>(n, 0.02), fs_hz).value() == relative(-arc));
}

TEST_CASE("SPARC of rest and of nothing is no number") {
    CHECK_FALSE(sparc(std::vector<double>(100, 0.0), 1000.0));
    CHECK_FALSE(sparc({}, 1000.0));
}

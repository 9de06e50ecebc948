#include "tasks/score/smoothness.h"

#include "relative.h"

#include "tasks/score/metrics.h"

#include <cmath>
#include <rapidcheck.h>

using tasks::ldlj;
using tasks::sub_movements;
using tasks::testing::relative;

namespace {

// Speed of a minimum-jerk movement of length D in T seconds, sampled at interval centres.
std::vector<double> minimum_jerk_speed(double length_m, double duration_s, double fs_hz) {
    const auto n = static_cast<std::size_t>(std::lround(duration_s * fs_hz));
    std::vector<double> speed(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double s = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
        speed[i] = 30.0 * length_m / duration_s * s * s * (1.0 - s) * (1.0 - s);
    }
    return speed;
}

} // namespace

TEST_CASE("LDLJ of the published test vector is -5.81636") {
    // Balasubramanian et al. 2015, reference implementation: v = exp(-5 t^2), fs = 100 Hz, T = N/fs
    std::vector<double> speed;
    for (int i = 0; i < 200; ++i) {
        const double t = -1.0 + 0.01 * i;
        speed.push_back(std::exp(-5.0 * t * t));
    }
    CHECK(ldlj(speed, 100.0).value() == relative(-5.81636, 1e-6));
}

TEST_CASE("LDLJ of a minimum-jerk movement is -ln(720/1.875^2), whatever its length and time") {
    // integral of (d2v/dt2)^2 = 720 D^2/T^5 and v_peak = 1.875 D/T
    const double expected = -std::log(720.0 / (1.875 * 1.875));
    for (const double duration_s : {0.5, 2.0})
        for (const double length_m : {0.01, 0.1}) {
            const auto speed = minimum_jerk_speed(length_m, duration_s, 1000.0);
            CHECK(ldlj(speed, 1000.0).value() == relative(expected, 5e-3));
        }
}

TEST_CASE("LDLJ does not depend on the unit of speed, nor on the direction of time") {
    CHECK(rc::check("scale and reversal", [](std::vector<int> cells) {
        RC_PRE(cells.size() >= 3u);
        std::vector<double> speed(cells.begin(), cells.end()), scaled = speed;
        for (double& v : scaled)
            v *= 4.0;
        const auto a = ldlj(speed, 1000.0), b = ldlj(scaled, 1000.0);
        const auto c = ldlj(std::vector<double>(speed.rbegin(), speed.rend()), 1000.0);
        RC_ASSERT(a.has_value() == b.has_value() && a.has_value() == c.has_value());
        if (a) {
            RC_ASSERT(std::abs(*a - *b) < 1e-9 * (1.0 + std::abs(*a)));
            RC_ASSERT(std::abs(*a - *c) < 1e-9 * (1.0 + std::abs(*a)));
        }
    }));
}

TEST_CASE("LDLJ of rest, of uniform acceleration and of two samples is no number") {
    CHECK_FALSE(ldlj(std::vector<double>(100, 0.0), 1000.0));
    CHECK_FALSE(ldlj(std::vector<double>{1.0, 2.0, 3.0, 4.0}, 1000.0));
    CHECK_FALSE(ldlj(std::vector<double>{1.0, 2.0}, 1000.0));
}

TEST_CASE("sub-movements are the runs above 2 mm/s that last 0.1 s") {
    std::vector<double> speed(1000, 0.0);
    const auto fill = [&](std::size_t from, std::size_t to, double v) {
        for (std::size_t i = from; i < to; ++i)
            speed[i] = v;
    };
    fill(0, 150, 0.01);    // from the first sample on
    fill(300, 399, 0.01);  // one sample too short
    fill(500, 600, 0.01);  // just long enough
    fill(650, 800, 0.002); // at the mark is not above it
    fill(850, 1000, 0.01); // to the last sample
    const auto found = sub_movements(speed, 1000.0);
    REQUIRE(found.size() == 3);
    CHECK(found[0].size() == 150);
    CHECK(found[1].data() == speed.data() + 500);
    CHECK(found[1].size() == 100);
    CHECK(found[2].data() == speed.data() + 850);
    CHECK(found[2].size() == 150);
}

TEST_CASE("the median of an even number of values is the mean of the middle two") {
    CHECK(tasks::median({3.0, 1.0, 2.0}).value() == 2.0);
    CHECK(tasks::median({4.0, 1.0, 2.0, 3.0}).value() == 2.5);
    CHECK_FALSE(tasks::median({}));
}

#include "sim/study/rigid_failures.h"

#include <doctest/doctest.h>
#include <set>

TEST_CASE("rigid failures: baselines fail where they are known to, ours nowhere") {
    const std::vector<sim::RigidFailureRow> rows = sim::run_rigid_failures();
    std::set<std::string> scenes, methods;
    for (const sim::RigidFailureRow& row : rows) {
        CAPTURE(row.scene);
        CAPTURE(row.method);
        CAPTURE(row.quantity);
        CAPTURE(row.value);
        CHECK(row.passed == (row.value <= row.bound));
        CHECK(row.passed == !row.expected_to_fail);
        scenes.insert(row.scene.substr(0, 3));
        methods.insert(row.method);
    }
    CHECK(scenes == std::set<std::string>{"F16", "F17"});
    CHECK(methods.size() >= 8);
}

TEST_CASE("rigid failures: springs per point ring from four on as published") {
    int found = 0;
    for (const sim::RigidFailureRow& row : sim::rigid_cluster_failures()) {
        if (row.method == "sum" && row.quantity == "spectral radius, 1 points")
            found += row.value == doctest::Approx(0.99825).scale(0.0).epsilon(1e-5);
        if (row.method == "sum" && row.quantity == "spectral radius, 4 points")
            found += row.value == doctest::Approx(1.00050).scale(0.0).epsilon(1e-5);
    }
    CHECK(found == 2);
}

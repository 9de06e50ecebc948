#include "sim/study/hcollide_study.h"

#include "haptics/collision/index.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>

namespace {

double longest_edge_over_height(const sim::StandIn& mesh, std::size_t t) {
    const auto [i, j, k] = mesh.triangle[t];
    const glm::dvec3 a = mesh.vertex_m[i], b = mesh.vertex_m[j], c = mesh.vertex_m[k];
    const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
    return longest * longest / glm::length(glm::cross(b - a, c - a));
}

} // namespace

TEST_CASE("hcollide study: stand-ins are as large as the models, and from a seed") {
    const std::vector<sim::StandIn> meshes = sim::make_stand_ins(1), again = sim::make_stand_ins(1);
    REQUIRE(meshes.size() == 3);
    CHECK(meshes[0].triangle.size() == 12000);
    CHECK(meshes[1].triangle.size() >= 18000);
    CHECK(meshes[1].triangle.size() < 18300);
    CHECK(meshes[2].triangle.size() == 79000);
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        CHECK(meshes[m].vertex_m == again[m].vertex_m);
        CHECK(meshes[m].triangle == again[m].triangle);
        haptics::make_index("brute-force", {meshes[m].vertex_m, meshes[m].triangle, {}});
    }
    // the assembly's character: a tenth of it slivers, longer than ten times their height
    std::size_t slivers = 0;
    for (std::size_t t = 0; t < meshes[1].triangle.size(); ++t)
        slivers += longest_edge_over_height(meshes[1], t) > 10.0;
    CHECK(10 * slivers > meshes[1].triangle.size());
}

TEST_CASE("hcollide study: all methods answer alike, every kind of query occurs and is counted") {
    const sim::HcollideOptions options{.seed = 3, .queries = 500, .rounds = 1};
    const sim::HcollideStudy study = run_hcollide_study(options, [](const std::string&) {});
    CHECK(study.row.size() == 3 * 2 * 2 * (haptics::kCollisionNames.size() - 1));
    for (const sim::HcollideRow& r : study.row) {
        CAPTURE(r.mesh);
        CAPTURE(r.method);
        CHECK(r.different == 0);
        CHECK(r.all.count == 1000);
        CHECK(r.counts.triangles > 0);
        for (const sim::QueryCost& kind : r.kind)
            CHECK(kind.count > 20);
    }
}

// sim/study/failure_rigid.cpp
// F16 and F17, tools in six degrees of freedom: the rows of rigid_failures.h among the others.
#include "sim/study/failure_bench.h"
#include "sim/study/rigid_failures.h"

namespace sim::failure {
namespace {

void append(const std::vector<RigidFailureRow>& from, Rows& rows) {
    for (const RigidFailureRow& r : from) {
        const std::size_t id = r.scene.find(' ');
        const std::string about = id == std::string::npos ? "" : r.scene.substr(id + 1) + ": ";
        rows.at_most(r.scene.substr(0, id), r.method, about + r.quantity, r.value, r.bound,
                     r.expected_to_fail);
    }
}

} // namespace

void rigid_clusters(std::uint64_t, Rows& rows) {
    append(rigid_cluster_failures(), rows);
}

void rigid_depths(std::uint64_t, Rows& rows) {
    append(rigid_depth_failures(), rows);
}

} // namespace sim::failure

// sim/study/rigid_failures.h
// Two scenes in which rigid contact in six degrees of freedom is known to fail, by method: a flat
// face sampled by many points, and tools so deep in thin or concave things that the nearest way out
// is not the way in. Baselines are expected to fail. Study only, some 100 ms.
#pragma once

#include <string>
#include <vector>

namespace sim {

/// One cell of the table: `passed` is value <= bound.
struct RigidFailureRow {
    std::string scene; // F16 or F17, and what it is
    std::string method;
    std::string quantity; // with its unit
    double value = 0.0, bound = 0.0;
    bool expected_to_fail = false;
    bool passed = false;
};

/// F16: a face of 20 x 20 mm on a plane by 1, 4, 16 and 64 points of 300 N/m, on a bare device of
/// 0.1 kg and 0.5 N s/m at 1 kHz. Methods: `sum` of springs, `count-mean` of the points that touch,
/// `voxel-springs` (McNeely, Puterbaugh, Troy 1999), `voxel-area` and `clusters` (ours).
std::vector<RigidFailureRow> rigid_cluster_failures();

/// F17: slab, L and U-channel along prescribed paths at 100 mm/s, and depths of random convex pairs
/// against brute force. Methods: `nearest-way-out` in every tick, `single-walk` from the line of
/// centres (Kim, Lin, Manocha 2002, without coherence), `coherent` (ours).
std::vector<RigidFailureRow> rigid_depth_failures();

/// Both.
std::vector<RigidFailureRow> run_rigid_failures();

} // namespace sim

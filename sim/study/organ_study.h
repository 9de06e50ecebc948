// sim/study/organ_study.h
// trocar study organ: force against depth at many places of a baked organ, and, with a second mesh
// of the same organ, how far the two agree place by place.
#pragma once

#include "sim/study/hold_side.h"
#include "sim/study/indent.h"

#include <filesystem>

namespace sim {

struct OrganStudyOptions {
    std::string organ, other; // names in the organ folder, or files; other: may be ""
    tissue::Material material;
    HoldSide hold; // of both
    int points = 50;
    std::uint64_t seed = 1;
    std::vector<double> depth_mm{1.0, 2.0, 4.0, 8.0};
    glm::dvec3 slide_from_mm{0.0, 0.0, 60.0}, slide_heading{1.0, 0.0, 0.0};
    double slide_mm = 30.0;
    int slide_steps = 60;
};

struct OrganStudy {
    int nodes = 0, tets = 0, other_nodes = 0, other_tets = 0;
    std::vector<IndentPoint> point, slide;             // on the first organ
    std::vector<IndentPoint> other_point, other_slide; // on the second, if any
    // of the force at each place and depth, second over first
    double ratio_min = 1.0, ratio_max = 1.0, ratio_mean = 1.0;
    double slide_step_percent = 0.0; // largest change of stiffness per step, of the mean
};
/// By name in the organ folder, or a file. Throws as read_bytes() and read_organ() do.
std::shared_ptr<const tissue::BakedOrgan> load_organ(const std::string& name);

OrganStudy run_organ_study(const OrganStudyOptions& options);

void write_organ_study(const OrganStudyOptions& options, const OrganStudy& study,
                       const std::filesystem::path& out);

} // namespace sim

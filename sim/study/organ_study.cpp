#include "sim/study/organ_study.h"

#include "sim/io/files.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace sim {
namespace {

std::vector<IndentPoint> press_all(Indenter& indenter, const std::vector<glm::dvec3>& places,
                                   std::span<const double> depth_m) {
    std::vector<IndentPoint> out;
    for (const glm::dvec3& place : places)
        out.push_back(indenter.press(place, depth_m));
    return out;
}

// As the first mesh was: the skins of two meshes may face elsewhere, a tool does not.
std::vector<IndentPoint> press_alike(Indenter& indenter, const std::vector<IndentPoint>& first,
                                     std::span<const double> depth_m) {
    std::vector<IndentPoint> out;
    for (const IndentPoint& point : first)
        out.push_back(indenter.press(point.place_m, point.normal, depth_m));
    return out;
}

void rate_pairs(OrganStudy& study) {
    double sum = 0.0;
    int count = 0;
    const auto rate = [&](const std::vector<IndentPoint>& a, const std::vector<IndentPoint>& b) {
        for (std::size_t i = 0; i < a.size(); ++i) {
            for (std::size_t d = 0; d < a[i].force_n.size(); ++d) {
                const double ratio = b[i].force_n[d] / a[i].force_n[d];
                study.ratio_min = count ? std::min(study.ratio_min, ratio) : ratio;
                study.ratio_max = count ? std::max(study.ratio_max, ratio) : ratio;
                sum += ratio;
                ++count;
            }
        }
    };
    rate(study.point, study.other_point);
    rate(study.slide, study.other_slide);
    study.ratio_mean = sum / count;
}

void rate_slide(OrganStudy& study) {
    double mean = 0.0;
    for (const IndentPoint& p : study.slide)
        mean += p.force_n.back();
    mean /= static_cast<double>(study.slide.size());
    for (std::size_t i = 1; i < study.slide.size(); ++i) {
        const double step =
            std::abs(study.slide[i].force_n.back() - study.slide[i - 1].force_n.back());
        study.slide_step_percent = std::max(study.slide_step_percent, 100.0 * step / mean);
    }
}

std::string lines(const char* what, const std::vector<IndentPoint>& points,
                  const std::vector<IndentPoint>& other, const std::vector<double>& depth_mm) {
    std::string csv;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const IndentPoint& p = points[i];
        for (std::size_t d = 0; d < depth_mm.size(); ++d) {
            csv += fmt::format(
                "{},{},{:.3f},{:.3f},{:.3f},{},{:.4f},{:.4f},{:.4f},{:.6f},{}\n", what, i,
                1e3 * p.place_m.x, 1e3 * p.place_m.y, 1e3 * p.place_m.z, depth_mm[d],
                1e3 * p.mesh_mpn, 1e3 * p.linear_mpn, 1e3 * p.tangential_mpn, p.force_n[d],
                other.empty() ? std::string() : fmt::format("{:.6f}", other[i].force_n[d]));
        }
    }
    return csv;
}

} // namespace

std::shared_ptr<const tissue::BakedOrgan> load_organ(const std::string& name) {
    const std::filesystem::path path =
        std::filesystem::exists(name) ? std::filesystem::path(name) : organ_path(name + ".organ");
    return std::make_shared<const tissue::BakedOrgan>(tissue::read_organ(read_bytes(path)));
}

OrganStudy run_organ_study(const OrganStudyOptions& o) {
    OrganStudy study;
    const auto organ = held_organ(load_organ(o.organ), o.hold);
    Indenter indenter(organ, o.material, organ->tip_radius_max_m);
    study.nodes = static_cast<int>(organ->mesh.rest_m.size() + organ->line.node_m.size());
    study.tets = static_cast<int>(organ->mesh.tets.size());
    std::vector<double> depth_m;
    for (const double d : o.depth_mm)
        depth_m.push_back(1e-3 * d);
    const auto places = random_places(indenter.body(), o.points, o.seed, PressedSkin::free);
    const auto path = slide_places(indenter.body(), 1e-3 * o.slide_from_mm, o.slide_heading,
                                   1e-3 * o.slide_mm, o.slide_steps);
    study.point = press_all(indenter, places, depth_m);
    study.slide = press_all(indenter, path, depth_m);
    rate_slide(study);
    if (o.other.empty())
        return study;
    const auto other = held_organ(load_organ(o.other), o.hold);
    Indenter second(other, o.material, other->tip_radius_max_m);
    study.other_nodes = static_cast<int>(other->mesh.rest_m.size() + other->line.node_m.size());
    study.other_tets = static_cast<int>(other->mesh.tets.size());
    study.other_point = press_alike(second, study.point, depth_m);
    study.other_slide = press_alike(second, study.slide, depth_m);
    rate_pairs(study);
    return study;
}

void write_organ_study(const OrganStudyOptions& o, const OrganStudy& study,
                       const std::filesystem::path& out) {
    std::filesystem::create_directories(out);
    std::string csv = "kind,index,x_mm,y_mm,z_mm,depth_mm,mesh_mm_per_n,linear_mm_per_n,"
                      "tangential_mm_per_n,force_n,other_force_n\n";
    csv += lines("point", study.point, study.other_point, o.depth_mm);
    csv += lines("slide", study.slide, study.other_slide, o.depth_mm);
    write_text(out / "organ.csv", csv);
}

} // namespace sim

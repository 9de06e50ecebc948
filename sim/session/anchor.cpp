#include "sim/session/anchor.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace sim {
namespace {

using glm::dvec3;
using tasks::Range;

constexpr Range kPlace_mm{-1000.0, 1000.0};
constexpr double kSlack_m = 1e-9; // a face of a box counts as inside

double box_distance(const AnchorBox& box, const dvec3& p) {
    const dvec3 out = glm::abs(p - 0.5 * (box.low_m + box.high_m)) - 0.5 * (box.high_m - box.low_m);
    return glm::length(glm::max(out, dvec3{0.0})) + std::min(0.0, std::max({out.x, out.y, out.z})) -
           kSlack_m;
}

double ball_distance(const AnchorBall& ball, const dvec3& p) {
    return glm::distance(p, ball.centre_m) - ball.radius_m;
}

// Answers "inside?" for points that come near one another: a distance d known at a place settles
// every point closer to that place than |d|.
class Inside {
  public:
    explicit Inside(std::vector<DistanceField> fields) : fields_(std::move(fields)) {}

    bool operator()(const dvec3& p) {
        constexpr double kRounding_m = 1e-12;
        if (std::abs(last_m_) > glm::distance(p, at_m_) + kRounding_m)
            return last_m_ < 0.0;
        at_m_ = p;
        last_m_ = std::numeric_limits<double>::max();
        for (const DistanceField& field : fields_)
            last_m_ = std::min(last_m_, field(p));
        return last_m_ <= 0.0;
    }

  private:
    std::vector<DistanceField> fields_;
    dvec3 at_m_{0.0};
    double last_m_ = 0.0; // settles nothing
};

Anchor parse_box(const tasks::TomlTable& t) {
    t.accept_only({"low_mm", "high_mm"});
    const AnchorBox box{t.place_mm("low_mm", kPlace_mm), t.place_mm("high_mm", kPlace_mm)};
    for (int axis = 0; axis < 3; ++axis) {
        if (!(box.low_m[axis] < box.high_m[axis]))
            t.refuse("high_mm", "a place above low_mm in x, y and z");
    }
    return box;
}

} // namespace

Anchor parse_anchor(const tasks::TomlTable& t) {
    const std::string kinds = "one of: low_mm and high_mm; centre_mm and radius_mm; touching and "
                              "within_mm; region";
    const bool box = t.has("low_mm") || t.has("high_mm");
    const bool ball = t.has("centre_mm") || t.has("radius_mm");
    const bool touching = t.has("touching") || t.has("within_mm");
    const bool region = t.has("region");
    const int given = box + ball + touching + region;
    if (given == 0) {
        t.accept_only({"low_mm", "high_mm", "centre_mm", "radius_mm", "touching", "within_mm",
                       "region"}); // a misspelt key is the likelier mistake
        t.refuse("anchor", kinds);
    }
    if (given > 1)
        t.refuse(region ? "region" : touching ? "touching" : "centre_mm", "only " + kinds);
    if (box)
        return parse_box(t);
    if (ball) {
        t.accept_only({"centre_mm", "radius_mm"});
        return AnchorBall{t.place_mm("centre_mm", kPlace_mm),
                          1e-3 * t.number("radius_mm", {0.1, 500.0})};
    }
    if (touching) {
        t.accept_only({"touching", "within_mm"});
        return AnchorTouching{t.text("touching"), 1e-3 * t.number("within_mm", {0.1, 50.0})};
    }
    t.accept_only({"region"});
    return AnchorRegion{t.text("region"), {}};
}

DistanceField anchor_distance(const Anchor& anchor,
                              std::shared_ptr<const tissue::BoundaryTree> surroundings) {
    if (const auto* box = std::get_if<AnchorBox>(&anchor))
        return [box = *box](const dvec3& p) { return box_distance(box, p); };
    if (const auto* ball = std::get_if<AnchorBall>(&anchor))
        return [ball = *ball](const dvec3& p) { return ball_distance(ball, p); };
    if (const auto* touching = std::get_if<AnchorTouching>(&anchor)) {
        return [within_m = touching->within_m, surface = std::move(surroundings)](const dvec3& p) {
            return tissue::nearest_point(*surface, p).distance_m - within_m;
        };
    }
    return [balls = std::get<AnchorRegion>(anchor).ball](const dvec3& p) {
        double least_m = std::numeric_limits<double>::max();
        for (const AnchorBall& ball : balls)
            least_m = std::min(least_m, ball_distance(ball, p));
        return least_m;
    };
}

std::vector<tissue::BedSample> bed_of(const tissue::TetMesh& mesh,
                                      std::vector<DistanceField> fields, double length_m) {
    auto inside = std::make_shared<Inside>(std::move(fields));
    return tissue::make_bed(
        mesh, [inside](const dvec3& p) { return (*inside)(p); }, length_m);
}

double held_volume_m3(std::span<const tissue::BedSample> bed, double length_m) noexcept {
    double sum_m = 0.0;
    for (const tissue::BedSample& sample : bed)
        sum_m += sample.stiffness_m;
    return sum_m * length_m * length_m;
}

} // namespace sim

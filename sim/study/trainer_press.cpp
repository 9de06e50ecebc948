// See the header.
#include "sim/study/trainer_press.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace sim {
namespace {

constexpr double kStep_s = 0.02;      // long steps settle soonest
constexpr double kSink_m = 0.25e-3;   // of a step while the tip sinks
constexpr double kSettled = 2e-4;     // of the force, from one step to the next
constexpr double kSettled_n = 1e-6;   // and that much
constexpr int kSettledFor = 8;        // steps in a row: longer than a sway is slow at its turn
constexpr int kMostSteps = 400;       // at one depth
constexpr double kSticks = 1e3;       // a coefficient of friction that nothing overcomes
constexpr double kStiffDevice = 1e12; // N/m: no coupling spring between tip and tissue
const glm::dvec3 kAway_m{0.0, 0.0, 10.0};

// The first centre along `into` at which a sphere touches the skin, from well above `place_m`.
glm::dvec3 first_touch_m(const Body& body, const glm::dvec3& place_m, const glm::dvec3& into,
                         double radius_m) {
    constexpr double kNear_m = 1e-8;
    glm::dvec3 centre_m = place_m - 3.0 * radius_m * into;
    for (int i = 0; i < 1000; ++i) {
        const double gap_m = nearest_on(body, centre_m).distance_m - radius_m;
        if (gap_m < kNear_m)
            break;
        centre_m += gap_m * into;
    }
    return centre_m;
}

} // namespace

TrainerTip::TrainerTip(std::shared_ptr<const tissue::BakedOrgan> organ, tissue::Material material,
                       double radius_m, double friction, tissue::Tier tier)
    : organ_(std::move(organ)), material_(std::move(material)), radius_m_(radius_m), tier_(tier),
      answer_(std::make_unique<TissueAnswer>()) {
    if (organ_->rigid || tier == tissue::Tier::rigid)
        throw std::invalid_argument("a rigid organ cannot be indented");
    material_.friction = std::min(friction, kSticks);
    rest();
}

void TrainerTip::rest() {
    std::vector<Body> bodies;
    bodies.push_back(
        make_body(organ_, material_, {radius_m_, radius_m_, radius_m_}, kStep_s, tier_));
    TissueConfig config;
    config.step_s = kStep_s;
    config.basis = false;
    rig_ = make_tissue_rig(std::move(bodies), config);
    rig_.device_npm.fill(kStiffDevice);
    tools_ = {};
    tools_.tip.fill({.centre_m = kAway_m, .radius_m = radius_m_});
    depth_m_ = 0.0;
}

void TrainerTip::sink(double depth_m, TrainerPress& out) {
    const int sinking = static_cast<int>(std::ceil((depth_m - depth_m_) / kSink_m));
    const double from_m = depth_m_;
    glm::dvec3 before_n = rig_.contact[0].force_n;
    int settled = 0;
    for (int i = 1; settled < kSettledFor; ++i) {
        if (i > kMostSteps + sinking) {
            out.settled = false;
            break;
        }
        depth_m_ = from_m + std::min(1.0, static_cast<double>(i) / sinking) * (depth_m - from_m);
        tools_.tip[0].centre_m = touch_m_ + depth_m_ * into_;
        ++tools_.tick;
        ++out.steps;
        out.warped |= tissue_step(rig_, tools_, *answer_).warped;
        const glm::dvec3 force_n = rig_.contact[0].force_n;
        const double change_n = glm::distance(force_n, before_n);
        const bool still = i > sinking && change_n <= kSettled * glm::length(force_n) + kSettled_n;
        settled = still ? settled + 1 : 0;
        before_n = force_n;
    }
    out.force_n.push_back(before_n);
}

TrainerPress TrainerTip::press(const glm::dvec3& near_m, const glm::dvec3& into,
                               std::span<const double> depth_m) {
    rest();
    TrainerPress out;
    const Foot foot = nearest_on(body(), near_m);
    out.place_m = place_on(body(), foot.at);
    out.normal = normal_on(body(), foot.at);
    into_ = into;
    touch_m_ = first_touch_m(body(), out.place_m, into, radius_m_);
    for (const double d : depth_m)
        sink(d, out);
    return out;
}

} // namespace sim

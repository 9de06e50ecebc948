// sim/study/trainer_press.h
// One press of a tip into an organ by the trainer's own step, slow enough to be statics: what the
// product would make anybody feel there, friction, local law and moving tissue included. Called by
// the organ study, which puts reference_press.h beside it.
#pragma once

#include "sim/loop/tissue_loop.h"

#include <span>

namespace sim {

struct TrainerPress {
    glm::dvec3 place_m{0.0}, normal{0.0}; // of the skin where it was pressed
    std::vector<glm::dvec3> force_n{};    // on the tip, for each depth
    int steps = 0;
    bool settled = true; // at every depth, within kSettled of the force
    bool warped = false; // a step fell back to another tangent than the exact one
};

/// An organ under one tip, all at rest. Stays where it was made.
class TrainerTip {
  public:
    TrainerTip(const TrainerTip&) = delete;
    /// `friction`: infinite is a tip that sticks. Throws std::invalid_argument for a rigid organ
    /// and as make_body() does.
    TrainerTip(std::shared_ptr<const tissue::BakedOrgan> organ, tissue::Material material,
               double radius_m, double friction, tissue::Tier tier);

    /// Along `into` (unit) through the skin nearest to `near_m`; depth 0 is where the tip first
    /// touches, depths ascend. From rest, whatever was pressed before.
    TrainerPress press(const glm::dvec3& near_m, const glm::dvec3& into,
                       std::span<const double> depth_m);
    const Body& body() const { return rig_.bodies.front(); }

  private:
    void rest();
    void sink(double depth_m, TrainerPress& out);

    std::shared_ptr<const tissue::BakedOrgan> organ_;
    tissue::Material material_;
    double radius_m_;
    tissue::Tier tier_;
    TissueRig rig_;
    ToolsNow tools_;
    std::unique_ptr<TissueAnswer> answer_;
    glm::dvec3 touch_m_{0.0}, into_{0.0}; // the tip's centre where it first touches
    double depth_m_ = 0.0;
};

} // namespace sim

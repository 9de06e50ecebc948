// tests/haptics/rigid_scenes.h
// Tools of one or more pieces over scenery, and the virtual device that presses them.
#pragma once

#include "haptics/rigid/convex_pieces.h"
#include "haptics/rigid/step_rigid.h"
#include "tests/haptics/convex_pieces.h"
#include "tests/haptics/rigid_surfaces.h"

inline haptics::RigidBody body(const char* name, std::vector<haptics::ConvexHull> piece,
                               const haptics::RigidPose& pose = {}) {
    return {haptics::make_shape(name, std::move(piece)), pose};
}

inline haptics::RigidBody body(const haptics::RigidSurface& surface,
                               const haptics::RigidPose& pose = {}) {
    return body(surface.name.c_str(), haptics::convex_pieces(surface, 2e-3), pose);
}

/// b = 0.5 N s/m and 1e-4 N m s/rad at 1 kHz: springs of 800 N/m and 0.16 N m/rad.
inline constexpr haptics::DeviceDamping kTestDevice{0.5, 1e-4, 1e-3};

struct RigidRig {
    haptics::RigidModel model;
    haptics::RigidState state{};
    haptics::RigidScratch scratch{};
    haptics::RigidTick tick{};

    RigidRig(std::vector<haptics::RigidBody> scenery, std::vector<haptics::RigidBody> tool,
             const haptics::RigidParams& params = {})
        : model(haptics::make_rigid_model(std::move(scenery), std::move(tool),
                                          std::array{kTestDevice, kTestDevice, kTestDevice},
                                          params)) {}

    const haptics::Wrench& step(const haptics::RigidPose& device) {
        haptics::step_rigid(model, {&device, 1}, state, scratch, tick);
        return tick.wrench[0];
    }
    const haptics::Wrench& settle(const haptics::RigidPose& device, int ticks = 300) {
        for (int i = 0; i < ticks; ++i)
            step(device);
        return tick.wrench[0];
    }
};

inline double degrees_between(const glm::dvec3& u, const glm::dvec3& v) {
    return 57.29577951308232 * std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

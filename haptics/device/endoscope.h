// haptics/device/endoscope.h
// An endoscope through its trocar: a rigid optic that looks `optic_rad` aside of its shaft, and a
// camera head on it. Both turn about the shaft, apart from each other: the camera head turns the
// picture, the optic turns where it looks. World frame. Any thread, pure.
//   shaft u, picture's up h: perpendicular to u in the plane of u and `up`, turned by camera_rad
//   looks along  cos(a) u + sin(a) (cos(t) h + sin(t) u x h),  a = optic angle, t = optic_rad
#pragma once

#include "haptics/device/trocar.h"

namespace haptics {

struct Endoscope {
    Trocar trocar;
    double optic_rad = 0.5235987755982988; // 30 degrees
    glm::dvec3 up{0.0, 1.0, 0.0};          // unit; what stands upright with a level horizon
};

struct EndoscopePicture {
    glm::dvec3 eye_m{0.0}, forward{0.0, 0.0, -1.0}, up{0.0, 1.0, 0.0}; // up, forward: orthonormal
};

/// `camera_rad`, `optic_rad`: turns of the camera head, and of the optic against it. Finite for
/// any shaft: one along `up` has a picture too, of no particular horizon.
EndoscopePicture picture_of(const Endoscope& scope, const ShaftPose& shaft, double camera_rad,
                            double optic_rad) noexcept;

/// How a scope has to be held to look at a place.
struct EndoscopeAim {
    glm::dvec3 tip_m{0.0}; // of the scope, the eye
    double camera_rad = 0.0, optic_rad = 0.0;
};

/// Looks straight at `place_m` from `distance_m` away, with the horizon turned by `horizon_rad`. An
/// oblique optic can do that from a circle of places; the one nearest to `near_m` is taken. Where
/// the shaft would be out of its trocar, or too far in, the distance gives way.
EndoscopeAim aim_at(const Endoscope& scope, const glm::dvec3& place_m, double distance_m,
                    const glm::dvec3& near_m, double horizon_rad) noexcept;

/// Turn of the picture against a level one; 0 where it looks along `up` and nothing is level.
double horizon_rad(const EndoscopePicture& picture, const glm::dvec3& up) noexcept;

} // namespace haptics

// sim/view/light.cpp
#include "sim/view/light.h"

#include "sim/view/camera_matrix.h"

namespace view {

double lamp(const Camera& camera, const glm::dvec3& place_m) {
    const glm::dvec3 ray = place_m - camera.eye_m;
    const double d2 = glm::dot(ray, ray);
    const double along = glm::dot(ray, glm::normalize(camera.look_at_m - camera.eye_m));
    const double rim2 = along > 0.0 && d2 > 0.0 ? along * along / d2 : 0.0;
    return rim2 * (0.16 * 0.16 + kLampSize2_m2) / (d2 + kLampSize2_m2);
}

double exposure(const ViewFrame& frame) {
    constexpr std::size_t kStride = 7;
    const Camera& camera = frame.camera;
    const glm::dvec3 ahead = glm::normalize(camera.look_at_m - camera.eye_m);
    const double least_along = std::cos(0.25 * field_of_view_rad(camera));
    double light = 0.0;
    int places = 0;
    for (const SurfaceView& surface : frame.surfaces) {
        if (surface.normal.size() != surface.position_m.size())
            continue; // not published yet
        for (std::size_t i = 0; i < surface.position_m.size(); i += kStride) {
            const glm::dvec3 ray = glm::dvec3(surface.position_m[i]) - camera.eye_m;
            const double d = glm::length(ray);
            if (glm::dot(ray, ahead) < least_along * d ||
                glm::dot(glm::dvec3(surface.normal[i]), ray) > 0.0)
                continue; // beside the middle, or turned away
            light += lamp(camera, surface.position_m[i]);
            ++places;
        }
    }
    return places > 0 ? std::clamp(places / std::max(light, 1e-9), 0.4, 2.5) : 1.0;
}

} // namespace view

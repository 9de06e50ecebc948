// sim/view/picture_targets.cpp
// Targets as flat marks on the tissue: colour, shape and number of their role.
#include "sim/view/camera_matrix.h"
#include "sim/view/picture.h"
#include "sim/view/tool_mesh.h"

namespace view {
namespace {

constexpr float kRingReach = 2.25F;  // half side of the square that holds the rings, in radii
constexpr float kLift_m = 0.0035F;   // depth only
constexpr float kBuried_m = 0.0005F; // less than what lies over it is thick

/// Axes of the mark: in the tangent plane, upright in the picture, turned at most 35 degrees from
/// the camera so that the number stays readable.
struct Axes {
    glm::dvec3 across, upward;
};
Axes axes_of(const Camera& camera, const TargetView& target) {
    const glm::dvec3 to_eye = glm::normalize(camera.eye_m - target.position_m);
    glm::dvec3 n = target.normal;
    const double facing = glm::dot(n, to_eye);
    if (facing < kLeastFacing) {
        const glm::dvec3 aside = n - facing * to_eye;
        const double length = glm::length(aside);
        const double sine = std::sqrt(1.0 - kLeastFacing * kLeastFacing);
        n = length > 1e-9 ? kLeastFacing * to_eye + sine / length * aside : to_eye;
    }
    const glm::dvec3 across = glm::normalize(glm::cross(camera.up, n));
    return {across, glm::cross(n, across)};
}

/// The role's letter, or one or two digits, centred; a third does not fit and is left out.
void set_text(const Program& program, const Digits& digits, const TargetView& target,
              float height) {
    std::array<glm::vec4, 2> uv{}, box{};
    const int shown = target.lift ? 10 + static_cast<int>(target.role) : target.number % 100;
    const int count = shown >= 10 && !target.lift ? 2 : 1;
    const std::array<int, 2> digit{count == 2 ? shown / 10 : shown,
                                   shown % 10}; // places in kGlyphs
    const float tall = count == 2 ? 0.78F * height : height;
    float advance = 0.0F;
    for (int i = 0; i < count; ++i)
        advance += digits.glyph[digit[i]].advance * tall;
    float pen = -0.5F * advance;
    for (int i = 0; i < count; ++i) {
        const Glyph& glyph = digits.glyph[digit[i]];
        const float middle = pen + 0.5F * glyph.advance * tall;
        uv[i] = glyph.uv;
        box[i] = {middle - 0.5F * glyph.width * tall, -0.5F * tall,
                  middle + 0.5F * glyph.width * tall, 0.5F * tall};
        pen += glyph.advance * tall;
    }
    program.set("glyph_uv", uv.data(), 2);
    program.set("glyph_box", box.data(), 2);
}

} // namespace

void Picture::draw_target(const ViewFrame& frame, const TargetView& target, const Digits& digits,
                          bool hidden) {
    const Axes axes = axes_of(frame.camera, target);
    const double radius_m = drawn_radius_m(frame.camera, lens_, target, height_px_);
    const bool next = target.state == TargetState::next, done = target.state == TargetState::done;
    const glm::vec3 colour = role_colour(target.role);
    glm::vec3 base = next ? colour : colour * 0.80F;
    if (done) // spent: grey, with a breath of its colour
        base = glm::mix(glm::vec3(0.42F), colour, 0.15F);
    const float opacity = (done ? 0.55F : next ? 1.0F : 0.92F) * (hidden ? 0.22F : 1.0F);
    const double beat = 0.5 + 0.5 * std::sin(2.0 * std::numbers::pi * 1.2 * frame.time_s);
    target_.set("centre_m", glm::vec3(target.position_m));
    target_.set("across_m", glm::vec3(radius_m * axes.across));
    target_.set("upward_m", glm::vec3(radius_m * axes.upward));
    target_.set("reach", next || target.lift          ? kRingReach
                         : target.role == Role::right ? 1.70F
                                                      : 1.10F);
    target_.set("shape", static_cast<int>(target.role));
    target_.set("base", base);
    target_.set("ink", done ? glm::vec3(0.80F) : glm::vec3(1.0F));
    target_.set("opacity", opacity);
    target_.set("ring", next ? static_cast<float>(1.40 + 0.25 * beat) : 0.0F);
    target_.set("hold", next ? static_cast<float>(std::clamp(target.hold_share, 0.0, 1.0)) : 0.0F);
    target_.set("arrow", target.lift ? 1 : 0);
    target_.set("lift_m", target.buried ? kBuried_m : kLift_m);
    set_text(target_, digits, target, target.role == Role::right ? 1.00F : 1.15F);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void Picture::draw_targets(const ViewFrame& frame, const Digits& digits, const glm::mat4& to_clip) {
    if (frame.targets.empty())
        return;
    see(target_, frame.camera, to_clip);
    target_.set("font", 0);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, digits.texture);
    glBindVertexArray(square_.id());
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    for (const TargetView& target : frame.targets) // faint where something stands before it
        if (target.state != TargetState::done && !target.buried) {
            glDepthFunc(GL_GREATER);
            draw_target(frame, target, digits, true);
        }
    glDepthFunc(GL_LESS);
    for (const TargetState state : {TargetState::done, TargetState::waiting, TargetState::next})
        for (const TargetView& target : frame.targets)
            if (target.state == state)
                draw_target(frame, target, digits, false);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

} // namespace view

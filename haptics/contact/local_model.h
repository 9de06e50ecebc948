// haptics/contact/local_model.h
// What the haptic loop knows of the tissue between two FEM answers: a small dynamic model of the
// tissue around the tools, made anew from every answer. Written by the tissue loop (50-200 Hz)
// into a newest-wins buffer, read by the 1 kHz loop. World frame, SI.
//
//   position of patch vertex v:  x_v = anchor_m[v] + sum_m mode(v, m) q_m
//   modes are mass-orthonormal:  q'' + (alpha + beta lambda) q' + lambda q + residual = load
// All tools near one body share that body's modes, which is what holds the cross terms; modes of
// different bodies stand side by side in one list and do not couple.
#pragma once

#include "haptics/contact/contact_rows.h"

#include <cstdint>

namespace haptics {

inline constexpr int kMaxModes = 36; // 11 for each of three tools, and a margin
inline constexpr int kMaxPatchVertices = 192;
inline constexpr int kMaxPatchTriangles = 352;
inline constexpr int kNoTriangle = -1;

struct PatchVertex {
    glm::dvec3 anchor_m{0.0};
    glm::dvec3 normal{0.0};             // unit, of the anchored shape, out of the tissue
    double radius_over_thickness = 0.0; // of this tool's tip and the tissue here
    double normal_mpn = 0.0;            // linear part of the sub-grid law, see LocalLaw
    double tangential_mpn = 0.0;
    std::array<double, 6> lean_mpn{}; // of the mesh, neither of these: xx, yy, zz, yz, xz, xy
};

struct PatchTriangle {
    std::array<std::int16_t, 3> vertex{};    // into ToolPatch::vertex
    std::array<std::int16_t, 3> neighbour{}; // across the edge opposite vertex k; -1: rim
    std::uint32_t id = 0;                    // in the body's surface: the same in every answer
};

/// Place on a surface: a triangle and barycentric weights that sum to 1.
struct SurfacePoint {
    int triangle = kNoTriangle;
    glm::dvec3 weight{0.0};
};

/// What one tool may touch before the next answer.
struct ToolPatch {
    bool near = false; // false: nothing within reach, the rest means nothing
    std::uint8_t body = 0;
    double friction = 0.0;
    const IndenterTable* table = nullptr; // nullptr: rigid
    double floor_mpn = 0.0;
    int first_mode = 0; // this body's range in LocalModels::lambda
    int modes = 0;      // 0: the body does not yield
    int vertices = 0;
    int triangles = 0;
    std::array<PatchVertex, kMaxPatchVertices> vertex;
    std::array<PatchTriangle, kMaxPatchTriangles> triangle;
    /// Mode shapes, metres per unit q: shape[v][axis][m], m from 0 within the body's range.
    std::array<std::array<std::array<double, kMaxModes>, 3>, kMaxPatchVertices> shape;

    // where the FEM step left this tool's contact, at sample_tick
    SurfacePoint contact;
    ContactMemory memory;
    glm::dvec3 force_n{0.0}; // on the tool
    int closing = 0;         // last closing of the jaws that the step knew of; also if not near
};

struct LocalModels {
    std::int64_t step = -1;       // FEM step number; -1: nothing yet
    std::int64_t sample_tick = 0; // tool tick that this answer belongs to
    int modes = 0;
    std::array<double, kMaxModes> lambda{};   // 1/s^2
    std::array<double, kMaxModes> damping{};  // alpha + beta lambda, 1/s
    std::array<double, kMaxModes> residual{}; // V^T (f_int - f_ext) at the answer
    std::array<double, kMaxModes> rate{};     // q' at the answer, V^T M v
    std::array<ToolPatch, kTools> tool;
};

} // namespace haptics

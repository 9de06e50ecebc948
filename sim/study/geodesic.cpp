#include "sim/study/geodesic.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <stdexcept>

namespace sim {
namespace {

using glm::dvec3;
using haptics::Corners;

constexpr double kGolden = 1.6180339887498949;

constexpr std::array<std::array<double, 3>, 12> kCorner{{{-1, kGolden, 0},
                                                         {1, kGolden, 0},
                                                         {-1, -kGolden, 0},
                                                         {1, -kGolden, 0},
                                                         {0, -1, kGolden},
                                                         {0, 1, kGolden},
                                                         {0, -1, -kGolden},
                                                         {0, 1, -kGolden},
                                                         {kGolden, 0, -1},
                                                         {kGolden, 0, 1},
                                                         {-kGolden, 0, -1},
                                                         {-kGolden, 0, 1}}};

constexpr std::array<std::array<int, 3>, 20> kFace{
    {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};

dvec3 corner(int face, int k) noexcept {
    const auto& c = kCorner[kFace[face][k]];
    return {c[0], c[1], c[2]};
}

int face_towards(const dvec3& direction) noexcept {
    int best = 0;
    double most = -2.0 * glm::length(direction) * 6.0;
    for (int f = 0; f < 20; ++f) {
        const double d = glm::dot(direction, corner(f, 0) + corner(f, 1) + corner(f, 2));
        if (d > most) {
            most = d;
            best = f;
        }
    }
    return best;
}

} // namespace

Geodesic::Geodesic(int cells) : cells_(cells) {
    if (cells < 1 || cells > 1000)
        throw std::invalid_argument("geodesic sphere: cells per edge must be 1 to 1000");
    std::map<std::pair<int, int>, int> number;
    for (int f = 0; f < 20; ++f)
        for (int k = 0; k < 3; ++k) {
            const auto ends = std::minmax(kFace[f][(k + 1) % 3], kFace[f][(k + 2) % 3]);
            edge_[f][k] = number.emplace(ends, static_cast<int>(number.size())).first->second;
        }
}

std::uint32_t Geodesic::vertex(int face, int i, int j) const noexcept {
    const std::array<int, 3> to{cells_ - i - j, i, j}; // how near to each corner
    for (int k = 0; k < 3; ++k)
        if (to[k] == cells_)
            return static_cast<std::uint32_t>(kFace[face][k]);
    for (int k = 0; k < 3; ++k)
        if (to[k] == 0) {
            // edges are counted from their smaller corner, so that both faces agree
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            const int along = kFace[face][a] < kFace[face][b] ? to[b] : to[a];
            return static_cast<std::uint32_t>(12 + edge_[face][k] * (cells_ - 1) + along - 1);
        }
    const int inner = (cells_ - 1) * (cells_ - 2) / 2;
    const int row = (j - 1) * (cells_ - 1) - j * (j - 1) / 2; // rows grow shorter
    return static_cast<std::uint32_t>(12 + 30 * (cells_ - 1) + face * inner + row + i - 1);
}

Corners Geodesic::pointing_up(int face, int i, int j) const noexcept {
    return {vertex(face, i, j), vertex(face, i + 1, j), vertex(face, i, j + 1)};
}

Corners Geodesic::pointing_down(int face, int i, int j) const noexcept {
    return {vertex(face, i + 1, j), vertex(face, i + 1, j + 1), vertex(face, i, j + 1)};
}

std::vector<dvec3> Geodesic::directions() const {
    std::vector<dvec3> out(static_cast<std::size_t>(10 * cells_ * cells_ + 2));
    for (int f = 0; f < 20; ++f)
        for (int j = 0; j <= cells_; ++j)
            for (int i = 0; i + j <= cells_; ++i)
                out[vertex(f, i, j)] = glm::normalize(
                    static_cast<double>(cells_ - i - j) * corner(f, 0) +
                    static_cast<double>(i) * corner(f, 1) + static_cast<double>(j) * corner(f, 2));
    return out;
}

std::vector<Corners> Geodesic::triangles() const {
    std::vector<Corners> out;
    out.reserve(static_cast<std::size_t>(20 * cells_ * cells_));
    for (int f = 0; f < 20; ++f)
        for (int j = 0; j < cells_; ++j)
            for (int i = 0; i + j < cells_; ++i) {
                out.push_back(pointing_up(f, i, j));
                if (i + j + 1 < cells_)
                    out.push_back(pointing_down(f, i, j));
            }
    return out;
}

Corners Geodesic::corners_at(const dvec3& direction) const noexcept {
    const int face = face_towards(direction);
    const dvec3 a = corner(face, 0), b = corner(face, 1), c = corner(face, 2);
    // Cramer: direction = wa a + wb b + wc c; scaled to sum n
    const double wa = glm::dot(direction, glm::cross(b, c));
    const double wb = glm::dot(direction, glm::cross(c, a));
    const double wc = glm::dot(direction, glm::cross(a, b));
    const double scale = cells_ / (wa + wb + wc);
    const double x = std::max(0.0, wb * scale), y = std::max(0.0, wc * scale);
    const int j = std::min(static_cast<int>(y), cells_ - 1);
    const int i = std::min(static_cast<int>(x), cells_ - 1 - j);
    const bool up = (x - i) + (y - j) <= 1.0 || i + j + 1 == cells_;
    return up ? pointing_up(face, i, j) : pointing_down(face, i, j);
}

} // namespace sim

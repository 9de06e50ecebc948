#include "haptics/collision/neighbours.h"

#include <algorithm>

namespace haptics {
namespace {

struct Edge {
    std::uint32_t low, high, triangle, corner;
    bool same_place(const Edge& other) const noexcept {
        return low == other.low && high == other.high;
    }
};

} // namespace

Neighbours make_neighbours(const MeshView& mesh) {
    std::vector<Edge> edge;
    for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.triangle[t][(k + 1) % 3],
                                b = mesh.triangle[t][(k + 2) % 3];
            edge.push_back({std::min(a, b), std::max(a, b), t, k});
        }
    std::stable_sort(edge.begin(), edge.end(), [](const Edge& a, const Edge& b) {
        return a.low != b.low ? a.low < b.low : a.high < b.high;
    });
    Neighbours out;
    out.across.assign(mesh.triangle.size(), {kNoSurface, kNoSurface, kNoSurface});
    for (std::size_t first = 0, end; first < edge.size(); first = end) {
        for (end = first + 1; end < edge.size() && edge[end].same_place(edge[first]); ++end)
            ;
        for (std::size_t i = first; end - first > 1 && i < end; ++i)
            out.across[edge[i].triangle][edge[i].corner] =
                edge[i + 1 < end ? i + 1 : first].triangle;
    }
    return out;
}

} // namespace haptics

#include "haptics/collision/neighbours.h"

#include <algorithm>

namespace haptics {

Neighbours make_neighbours(const MeshView& mesh) {
    std::vector<std::vector<std::uint32_t>> around(mesh.vertex_m.size());
    for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t)
        for (const std::uint32_t v : mesh.triangle[t])
            around[v].push_back(t);
    Neighbours out;
    std::vector<std::uint32_t> ring;
    for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t) {
        out.first.push_back(static_cast<std::uint32_t>(out.triangle.size()));
        ring.clear();
        for (const std::uint32_t v : mesh.triangle[t])
            ring.insert(ring.end(), around[v].begin(), around[v].end());
        std::sort(ring.begin(), ring.end());
        ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
        ring.erase(std::find(ring.begin(), ring.end(), t));
        out.triangle.insert(out.triangle.end(), ring.begin(), ring.end());
    }
    out.first.push_back(static_cast<std::uint32_t>(out.triangle.size()));
    return out;
}

} // namespace haptics

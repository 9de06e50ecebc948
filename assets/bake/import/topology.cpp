#include "assets/bake/import/topology.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace bake {
namespace {

struct EdgeUse {
    std::uint64_t key = 0; // both points, the smaller one first
    std::uint32_t half = 0;
};

std::vector<EdgeUse> sorted_edges(const Surface& s) {
    std::vector<EdgeUse> uses(3 * s.triangles.size());
    for (std::size_t h = 0; h < uses.size(); ++h) {
        const std::uint64_t a = from_point(s, h), b = to_point(s, h);
        uses[h] = {std::min(a, b) << 32 | std::max(a, b), static_cast<std::uint32_t>(h)};
    }
    std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
        return a.key != b.key ? a.key < b.key : a.half < b.half;
    });
    return uses;
}

template <class F> void each_edge(const std::vector<EdgeUse>& uses, F&& f) {
    for (std::size_t first = 0, last = 0; first < uses.size(); first = last) {
        while (last < uses.size() && uses[last].key == uses[first].key) {
            ++last;
        }
        f(std::span(uses).subspan(first, last - first));
    }
}

/// Makes neighbours across edges of exactly two triangles agree. A piece keeps the way most of its
/// triangles had.
void orient(Surface& s, Topology& topology) {
    std::vector<std::int32_t> across(3 * s.triangles.size(), -1);
    each_edge(sorted_edges(s), [&](std::span<const EdgeUse> edge) {
        if (edge.size() == 2) {
            across[edge[0].half] = static_cast<std::int32_t>(edge[1].half);
            across[edge[1].half] = static_cast<std::int32_t>(edge[0].half);
        }
    });
    enum : char { kUnseen = 0, kKept = 1, kTurned = 2 };
    std::vector<char> way(s.triangles.size(), kUnseen);
    std::vector<std::uint32_t> piece;
    for (std::uint32_t first = 0; first < s.triangles.size(); ++first) {
        if (way[first] != kUnseen) {
            continue;
        }
        way[first] = kKept;
        piece.assign(1, first);
        std::size_t turned = 0;
        for (std::size_t i = 0; i < piece.size(); ++i) {
            const std::uint32_t t = piece[i];
            for (std::size_t h = 3 * t; h < 3 * t + 3; ++h) {
                if (across[h] < 0) {
                    continue;
                }
                const auto other = static_cast<std::size_t>(across[h]);
                const bool agree = from_point(s, h) == to_point(s, other);
                const char wanted = agree == (way[t] == kKept) ? kKept : kTurned;
                char& now = way[other / 3];
                if (now == kUnseen) {
                    now = wanted;
                    turned += wanted == kTurned ? 1 : 0;
                    piece.push_back(static_cast<std::uint32_t>(other / 3));
                } else if (now != wanted && !topology.one_sided_at) {
                    topology.one_sided_at = t;
                }
            }
        }
        const char turn = 2 * turned > piece.size() ? kKept : kTurned; // as few as possible
        for (const auto t : piece) {
            if (way[t] == turn) {
                std::swap(s.triangles[t][1], s.triangles[t][2]);
                ++topology.turned;
            }
        }
    }
}

/// Around an edge of many triangles, each wedge of the solid gets its two sides: from a triangle
/// that runs against the edge, by growing angle, to the next that runs along it. False if they do
/// not alternate.
bool pair_around(const Surface& s, std::span<const EdgeUse> edge, std::vector<std::int32_t>& twin) {
    const auto low = static_cast<std::uint32_t>(edge[0].key >> 32);
    const auto high = static_cast<std::uint32_t>(edge[0].key);
    const glm::dvec3 axis = glm::normalize(s.point_m[high] - s.point_m[low]);
    const glm::dvec3 any = std::abs(axis.x) < 0.6 ? glm::dvec3{1, 0, 0} : glm::dvec3{0, 1, 0};
    const glm::dvec3 u = glm::normalize(glm::cross(axis, any)), v = glm::cross(axis, u);
    struct Leaf {
        double angle;
        bool along;
        std::uint32_t half;
    };
    std::vector<Leaf> leaves;
    for (const auto& use : edge) {
        const std::size_t opposite = use.half / 3 * 3 + (use.half + 2 - use.half / 3 * 3) % 3;
        const glm::dvec3 r = s.point_m[from_point(s, opposite)] - s.point_m[low];
        leaves.push_back(
            {std::atan2(glm::dot(r, v), glm::dot(r, u)), from_point(s, use.half) == low, use.half});
    }
    std::sort(leaves.begin(), leaves.end(), [](const Leaf& a, const Leaf& b) {
        if (a.angle != b.angle) {
            return a.angle < b.angle;
        }
        return a.along != b.along ? a.along
                                  : a.half < b.half; // bodies that touch: close, then open
    });
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        if (leaves[i].along == leaves[(i + 1) % leaves.size()].along) {
            return false;
        }
    }
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        const Leaf &a = leaves[i], &b = leaves[(i + 1) % leaves.size()];
        if (!a.along) {
            twin[a.half] = static_cast<std::int32_t>(b.half);
            twin[b.half] = static_cast<std::int32_t>(a.half);
        }
    }
    return true;
}

/// Every fan of triangles around a point gets a point of its own.
void split_points(Surface& s, const std::vector<std::int32_t>& twin) {
    std::vector<char> taken(s.point_m.size(), 0), done(twin.size(), 0);
    for (std::size_t start = 0; start < twin.size(); ++start) {
        if (done[start]) {
            continue;
        }
        // the corner at the beginning of a half edge; turn one way, then the other
        std::vector<std::size_t> fan;
        std::size_t h = start;
        bool open = false;
        do {
            fan.push_back(h);
            done[h] = 1;
            const auto next = twin[h / 3 * 3 + (h + 2 - h / 3 * 3) % 3];
            open = next < 0;
            h = open ? h : static_cast<std::size_t>(next);
        } while (!open && h != start && !done[h]);
        for (h = start; open && twin[h] >= 0;) {
            const auto other = static_cast<std::size_t>(twin[h]);
            h = other / 3 * 3 + (other % 3 + 1) % 3;
            if (done[h]) {
                break;
            }
            fan.push_back(h);
            done[h] = 1;
        }
        const std::uint32_t point = from_point(s, start);
        if (!taken[point]) {
            taken[point] = 1;
            continue;
        }
        s.point_m.push_back(s.point_m[point]);
        for (const auto corner : fan) {
            s.triangles[corner / 3][corner % 3] = static_cast<std::uint32_t>(s.point_m.size() - 1);
        }
    }
}

} // namespace

Topology make_manifold(Surface& s) {
    Topology topology;
    orient(s, topology);
    topology.twin.assign(3 * s.triangles.size(), -1);
    each_edge(sorted_edges(s), [&](std::span<const EdgeUse> edge) {
        if (edge.size() == 2 && from_point(s, edge[0].half) != from_point(s, edge[1].half)) {
            topology.twin[edge[0].half] = static_cast<std::int32_t>(edge[1].half);
            topology.twin[edge[1].half] = static_cast<std::int32_t>(edge[0].half);
        } else if (edge.size() > 2) {
            ++topology.shared_edges;
            pair_around(s, edge, topology.twin);
        }
    });
    for (const auto t : topology.twin) {
        topology.open_edges += t < 0 ? 1 : 0;
    }
    split_points(s, topology.twin);
    return topology;
}

std::vector<std::uint32_t> pieces(const Topology& topology, std::size_t& count) {
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> piece(topology.twin.size() / 3, kNone), open;
    count = 0;
    for (std::uint32_t first = 0; first < piece.size(); ++first) {
        if (piece[first] != kNone) {
            continue;
        }
        piece[first] = static_cast<std::uint32_t>(count);
        open.assign(1, first);
        while (!open.empty()) {
            const std::size_t t = open.back();
            open.pop_back();
            for (std::size_t h = 3 * t; h < 3 * t + 3; ++h) {
                const auto other = topology.twin[h] < 0 ? -1 : topology.twin[h] / 3;
                if (other >= 0 && piece[static_cast<std::size_t>(other)] == kNone) {
                    piece[static_cast<std::size_t>(other)] = static_cast<std::uint32_t>(count);
                    open.push_back(static_cast<std::uint32_t>(other));
                }
            }
        }
        ++count;
    }
    return piece;
}

std::vector<Surface> split(const Surface& s, const std::vector<std::uint32_t>& piece,
                           const std::vector<std::int32_t>& part, std::size_t parts) {
    std::vector<Surface> result(parts);
    std::vector<std::int64_t> renamed(s.point_m.size(), -1); // a point belongs to one piece
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
        const std::int32_t to = part[piece[t]];
        if (to < 0) {
            continue;
        }
        Surface& out = result[static_cast<std::size_t>(to)];
        tissue::Triangle triangle = s.triangles[t];
        for (auto& v : triangle) {
            if (renamed[v] < 0) {
                renamed[v] = static_cast<std::int64_t>(out.point_m.size());
                out.point_m.push_back(s.point_m[v]);
            }
            v = static_cast<std::uint32_t>(renamed[v]);
        }
        out.triangles.push_back(triangle);
    }
    return result;
}

Surface joined(const std::vector<const Surface*>& parts) {
    Surface all;
    for (const Surface* part : parts) {
        const auto first = static_cast<std::uint32_t>(all.point_m.size());
        all.point_m.insert(all.point_m.end(), part->point_m.begin(), part->point_m.end());
        for (const auto& t : part->triangles) {
            all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        }
    }
    return all;
}

} // namespace bake

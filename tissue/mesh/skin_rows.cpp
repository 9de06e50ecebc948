// Compiled once for each instruction set; which one runs is decided at the first call. A node's
// three coordinates are one vector, so that an entry of a row is one load and one multiply-add.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tissue/mesh/skin_rows.cpp"
#include "tissue/mesh/skin_rows.h"

#include <hwy/foreach_target.h> // must come before highway.h

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tissue::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void carry(const ContactSurface& surface, std::span<const glm::dvec3> node_m,
           std::span<glm::dvec3> position_m) {
    constexpr hn::CappedTag<double, 4> kTag;
    const std::size_t step = hn::Lanes(kTag); // 4, 2 or 1: three coordinates in one pass or more
    // a load of four reads on into the next node; after the last one there is none
    const std::size_t last = node_m.size() - 1;
    const std::array<double, 4> end{node_m[last].x, node_m[last].y, node_m[last].z, 0.0};
    for (std::size_t v = 0; v < position_m.size(); ++v) {
        const std::uint32_t stop = surface.row_start[v + 1];
        std::array<double, 4> carried{};
        for (std::size_t c = 0; c < 3; c += step) {
            const auto entry = [&](std::uint32_t k, auto sum) {
                const std::size_t node = surface.row_node[k];
                const double* at = node == last ? end.data() : &node_m[node].x;
                return hn::MulAdd(hn::Set(kTag, surface.row_weight[k]), hn::LoadU(kTag, at + c),
                                  sum);
            };
            // two sums, so that one multiply-add need not wait for the one before
            auto even = hn::Zero(kTag), odd = hn::Zero(kTag);
            std::uint32_t k = surface.row_start[v];
            for (; k + 1 < stop; k += 2) {
                even = entry(k, even);
                odd = entry(k + 1, odd);
            }
            if (k < stop)
                even = entry(k, even);
            hn::StoreU(hn::Add(even, odd), kTag, carried.data() + c);
        }
        position_m[v] = {carried[0], carried[1], carried[2]};
    }
}

} // namespace tissue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tissue {

HWY_EXPORT(carry);

void carry_rows(const ContactSurface& surface, std::span<const glm::dvec3> node_m,
                std::span<glm::dvec3> position_m) noexcept {
    static_assert(sizeof(glm::dvec3) == 3 * sizeof(double));
    if (!node_m.empty())
        HWY_DYNAMIC_DISPATCH(carry)(surface, node_m, position_m);
}

} // namespace tissue
#endif

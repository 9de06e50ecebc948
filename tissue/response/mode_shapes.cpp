// See the header. Called by sim/bridge in the tissue loop, once per patch vertex and FEM step.
// Compiled once for each instruction set; which one runs is decided at the first call.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tissue/response/mode_shapes.cpp"
#include "tissue/response/mode_shapes.h"

#include <hwy/foreach_target.h> // must come before highway.h

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tissue::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// The nodes of a row that can move, and the lines of the basis there.
struct Row {
    Dofs dofs;
    std::span<const std::uint32_t> node;
    std::span<const double> weight;
    const double* by_unknown;
    std::size_t modes;
    template <typename Work> void for_lines(std::size_t axis, Work work) const {
        for (std::size_t k = 0; k < node.size(); ++k) {
            const std::int32_t dof = dofs[node[k]];
            if (dof >= 0)
                work(weight[k], by_unknown + (static_cast<std::size_t>(dof) + axis) * modes);
        }
    }
};

} // namespace

void mix_lines(Dofs dofs, const ContactSurface& surface, std::uint32_t vertex,
               const double* by_unknown, std::size_t modes, const std::array<double*, 3>& out) {
    constexpr hn::CappedTag<double, 4> kTag;
    const std::size_t step = hn::Lanes(kTag), first = surface.row_start[vertex],
                      count = surface.row_start[vertex + 1] - first;
    const Row row{dofs, std::span(surface.row_node).subspan(first, count),
                  std::span(surface.row_weight).subspan(first, count), by_unknown, modes};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::size_t m = 0;
        for (; m + step <= modes; m += step) {
            auto sum = hn::Zero(kTag);
            row.for_lines(axis, [&](double weight, const double* line) {
                sum = hn::MulAdd(hn::Set(kTag, weight), hn::LoadU(kTag, line + m), sum);
            });
            hn::StoreU(sum, kTag, out[axis] + m);
        }
        for (; m < modes; ++m) {
            double sum = 0.0;
            row.for_lines(axis,
                          [&](double weight, const double* line) { sum += weight * line[m]; });
            out[axis][m] = sum;
        }
    }
}

} // namespace tissue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tissue {

HWY_EXPORT(mix_lines);

void turn_shapes(const ContactBasis& basis, int unknowns, std::span<double> by_unknown) noexcept {
    const std::size_t n = static_cast<std::size_t>(unknowns);
    const std::size_t modes = static_cast<std::size_t>(basis.modes);
    for (std::size_t m = 0; m < modes; ++m) {
        const double* column = basis.shape.data() + m * n;
        for (std::size_t d = 0; d < n; ++d)
            by_unknown[d * modes + m] = column[d];
    }
}

void vertex_shapes(Dofs dofs, const ContactSurface& surface, std::uint32_t vertex,
                   std::span<const double> by_unknown, int modes,
                   const std::array<double*, 3>& out) noexcept {
    HWY_DYNAMIC_DISPATCH(mix_lines)
    (dofs, surface, vertex, by_unknown.data(), static_cast<std::size_t>(modes), out);
}

} // namespace tissue
#endif

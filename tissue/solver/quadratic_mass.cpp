// Compiled once for each instruction set; which one runs is decided at the first call.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tissue/solver/quadratic_mass.cpp"
#include "tissue/solver/quadratic_linear.h"

#include <hwy/foreach_target.h> // must come before highway.h

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tissue::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// A node at a time: the four numbers of its neighbours, each times what they have in common. Four
// sums that do not wait for each other.
template <typename T>
void product(const QuadraticModel& model, const T* S, T factor, const T* x, T* y) noexcept {
    constexpr hn::CappedTag<T, 4> kTag;
    const int step = static_cast<int>(hn::Lanes(kTag));
    for (std::size_t i = 0; i + 1 < model.mass_start.size(); ++i) {
        for (int c = 0; c < 4; c += step) {
            const auto term = [&](std::int32_t k, hn::Vec<decltype(kTag)> sum) {
                return hn::MulAdd(hn::Set(kTag, S[k]),
                                  hn::LoadU(kTag, x + model.mass_column[k] + c), sum);
            };
            std::int32_t k = model.mass_start[i];
            const std::int32_t end = model.mass_start[i + 1];
            auto s0 = hn::Zero(kTag), s1 = s0, s2 = s0, s3 = s0;
            for (; k + 3 < end; k += 4) {
                s0 = term(k, s0);
                s1 = term(k + 1, s1);
                s2 = term(k + 2, s2);
                s3 = term(k + 3, s3);
            }
            for (; k < end; ++k)
                s0 = term(k, s0);
            const auto sum = hn::Add(hn::Add(s0, s1), hn::Add(s2, s3));
            hn::StoreU(hn::Mul(hn::Set(kTag, factor), sum), kTag, y + 4 * i + c);
        }
    }
}

} // namespace

void product_double(const QuadraticModel& model, const double* S, double factor, const double* x,
                    double* y) {
    product(model, S, factor, x, y);
}
void product_single(const QuadraticModel& model, const float* S, const float* x, float* y) {
    product(model, S, 1.0f, x, y);
}

} // namespace tissue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tissue {

HWY_EXPORT(product_double);
HWY_EXPORT(product_single);

void scalar_product(const QuadraticModel& model, std::span<const double> S, double factor,
                    const NodeVector<double>& x, NodeVector<double>& y) noexcept {
    HWY_DYNAMIC_DISPATCH(product_double)(model, S.data(), factor, x.data(), y.data());
}

void scalar_product(const QuadraticModel& model, std::span<const float> S,
                    const NodeVector<float>& x, NodeVector<float>& y) noexcept {
    HWY_DYNAMIC_DISPATCH(product_single)(model, S.data(), x.data(), y.data());
}

} // namespace tissue
#endif

// sim/view/tissue_style.cpp
// Design values, chosen by eye beside photographs of laparoscopies in daylight white balance.
#include "sim/view/tissue_style.h"

#include <cstddef>

namespace view {
namespace {

constexpr std::array<TissueStyle, kLookWords.size()> kStyles{{
    // deep, pale, vein, coarse, fine tiles, fine share, veins, small veins, wet, bumps
    {{0.130F, 0.016F, 0.012F},
     {0.330F, 0.062F, 0.042F},
     {0.40F, 0.16F, 0.10F},
     5.0F,
     29.0F,
     0.45F,
     0.00F,
     0.22F,
     0.60F,
     0.45F}, // liver: lobules as pale threads
    {{0.400F, 0.150F, 0.110F},
     {0.600F, 0.310F, 0.240F},
     {0.34F, 0.045F, 0.05F},
     6.0F,
     23.0F,
     0.25F,
     0.60F,
     0.30F,
     0.50F,
     0.40F}, // stomach
    {{0.085F, 0.011F, 0.022F},
     {0.210F, 0.034F, 0.050F},
     {0.05F, 0.006F, 0.02F},
     6.0F,
     31.0F,
     0.50F,
     0.00F,
     0.20F,
     0.65F,
     0.40F}, // spleen
    {{0.190F, 0.040F, 0.024F},
     {0.340F, 0.100F, 0.064F},
     {0.11F, 0.012F, 0.012F},
     6.0F,
     27.0F,
     0.35F,
     0.15F,
     0.25F,
     0.55F,
     0.35F}, // kidney
    {{0.480F, 0.190F, 0.140F},
     {0.680F, 0.380F, 0.300F},
     {0.42F, 0.050F, 0.055F},
     8.0F,
     25.0F,
     0.25F,
     0.55F,
     0.50F,
     0.60F,
     0.40F}, // bowel
    {{0.460F, 0.210F, 0.100F},
     {0.720F, 0.450F, 0.240F},
     {0.40F, 0.080F, 0.05F},
     9.0F,
     33.0F,
     0.80F,
     0.15F,
     0.20F,
     0.45F,
     0.60F}, // pancreas: lobules
    {{0.560F, 0.310F, 0.075F},
     {0.820F, 0.590F, 0.220F},
     {0.48F, 0.090F, 0.05F},
     9.0F,
     26.0F,
     0.60F,
     0.35F,
     0.20F,
     0.35F,
     0.60F}, // fat
    {{0.060F, 0.105F, 0.060F},
     {0.210F, 0.270F, 0.150F},
     {0.22F, 0.040F, 0.03F},
     8.0F,
     23.0F,
     0.25F,
     0.55F,
     0.35F,
     0.65F,
     0.35F}, // gallbladder
    {{0.360F, 0.040F, 0.030F},
     {0.560F, 0.130F, 0.095F},
     {0.66F, 0.300F, 0.240F},
     60.0F,
     90.0F,
     0.30F,
     0.35F,
     0.20F,
     0.60F,
     0.30F}, // artery: muscle in rings, vessels of its own wall
    {{0.052F, 0.022F, 0.085F},
     {0.130F, 0.070F, 0.190F},
     {0.03F, 0.010F, 0.050F},
     30.0F,
     60.0F,
     0.25F,
     0.30F,
     0.00F,
     0.65F,
     0.25F}, // vein: thin wall over dark blood
    {{0.270F, 0.260F, 0.060F},
     {0.480F, 0.470F, 0.170F},
     {0.40F, 0.150F, 0.050F},
     30.0F,
     70.0F,
     0.35F,
     0.00F,
     0.35F,
     0.60F,
     0.30F}, // duct: bile through its wall, a fine net of vessels
    {{0.420F, 0.150F, 0.105F},
     {0.560F, 0.300F, 0.175F},
     {0.28F, 0.035F, 0.035F},
     5.0F,
     0.0F,
     0.00F,
     0.60F,
     0.00F,
     0.14F,
     0.60F}, // wall: peritoneum over fat
    {{0.330F, 0.095F, 0.070F},
     {0.500F, 0.200F, 0.150F},
     {0.25F, 0.040F, 0.035F},
     6.0F,
     27.0F,
     0.40F,
     0.20F,
     0.20F,
     0.50F,
     0.45F}, // tissue
}};

} // namespace

const TissueStyle& style_of(Look look) noexcept {
    return kStyles[static_cast<std::size_t>(look)];
}

} // namespace view

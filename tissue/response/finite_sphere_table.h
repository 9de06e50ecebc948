// tissue/response/finite_sphere_table.h
// F/(E a^2) of a stuck hemisphere of radius a in a neo-Hookean half-space. Read by
// finite_sphere.cpp. Made by `trocar study indenter`, which prints these figures: cells of 0.1 a,
// 150 a of tissue, steps of 0.1 a. Cells of 0.15 a and a third of the penalty change no force by
// more than 0.5 %.
#pragma once

#include <array>

namespace tissue {

inline constexpr std::array<double, 4> kFinitePoisson{0.3, 0.4, 0.45, 0.49};

// d/a
inline constexpr std::array<double, 23> kFiniteDepth{0.2, 0.3,  0.4, 0.5, 0.6, 0.8, 1, 1.25,
                                                     1.5, 1.75, 2,   2.5, 3,   3.5, 4, 4.5,
                                                     5,   5.5,  6,   6.5, 7,   7.5, 8};

inline constexpr std::array<std::array<double, kFiniteDepth.size()>, kFinitePoisson.size()>
    kFiniteForce{{{0.13403,  0.24595,  0.37831,  0.52763,  0.69213,  1.05982,  1.47220,  2.04104,
                   2.65939,  3.32186,  4.02131,  5.50694,  7.08107,  8.72674,  10.42455, 12.15423,
                   13.90832, 15.65526, 17.41436, 19.15390, 20.92017, 22.67533, 24.42114},
                  {0.14093,  0.25716,  0.39320,  0.54579,  0.71280,  1.08186,  1.49066, 2.04720,
                   2.64285,  3.27193,  3.92686,  5.29063,  6.70820,  8.16777,  9.67522, 11.21559,
                   12.78817, 14.38658, 16.00048, 17.64336, 19.29541, 20.98008, 22.67829},
                  {0.14598,  0.26525,  0.40442,  0.55956,  0.72855,  1.10160,  1.51096, 2.06328,
                   2.65248,  3.26552,  3.90072,  5.20397,  6.53866,  7.91784,  9.33756, 10.80640,
                   12.32543, 13.88110, 15.47634, 17.10492, 18.78002, 20.46530, 22.18802},
                  {0.15096,  0.27310,  0.41534,  0.57341,  0.74435,  1.11983,  1.53040, 2.08015,
                   2.66008,  3.26234,  3.88130,  5.13693,  6.42255,  7.74355,  9.12183, 10.55401,
                   12.05352, 13.61010, 15.24418, 16.92731, 18.68773, 20.47892, 22.33210}}};

} // namespace tissue

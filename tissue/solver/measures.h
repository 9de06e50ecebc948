// tissue/solver/measures.h
// What a tissue bears, for scores and checks: energy, volume, stress, and how much of it was hurt.
// Called in the tissue loop after a step, for any tier: no allocation, any state.
//   von Mises stress: of the Cauchy stress, sqrt(3/2 dev sigma : dev sigma); of corotated tissue
//   that of stress.h. With a memory it is the stress now.
//   true strain: largest |ln s| of the principal stretches s
// Constant in a corotated tet, taken at the four points of a quadratic one. Shares are of the rest
// volume. What is inside out has no stress or strain; it is counted, and over every limit.
// Costs a tenth of a quadratic step (240 tets), a sixth of a corotated one (540 and 1920 tets).
// Limits belong to the tissue. Liver broke under 0.27 MPa at a true strain of 0.38 (compilation in
// PMC6925591), a stiffer curve than that of small strains: with the moduli of gentle handling it is
// the strain that is reached. Injury follows peak stress and how long it is borne (De, Rosen,
// Dagan, Hannaford, Swanson & Sinanan 2007); bowel was safe under 330 kPa for 10 s
// (10.1136/bmjsit-2021-000084).
#pragma once

#include "tissue/solver/corotated.h"
#include "tissue/solver/quadratic.h"

namespace tissue {

/// > 0 each.
struct DamageLimits {
    double von_mises_pa = 0.27e6;
    double true_strain = 0.38;
    double impulse_pas = 3.3e6; // von Mises stress times time, summed
};

struct TissueMeasures {
    double stored_j = 0.0; // elastic, of the tets; with a memory what could be had back
    double volume_m3 = 0.0;
    double volume_change = 0.0; // of the rest volume
    double peak_von_mises_pa = 0.0;
    double high_von_mises_pa = 0.0; // 99 % of the tissue bears less
    double over_share = 0.0;        // over a limit of stress or strain now
    double hurt_share = 0.0;        // has been, or has borne more than the limit of impulse
    int inverted = 0;               // tets, or points of quadratic ones
};

/// What an attempt did to a body so far, and scratch; sized by make_tissue_log().
struct TissueLog {
    struct Sample {
        float von_mises_pa, rest_volume_m3;
    };
    std::vector<float> impulse_pas; // per tet, or lane of a point of a group
    std::vector<std::uint8_t> over; // now: 1, has been: 2
    std::vector<Sample> sample;
};
TissueLog make_tissue_log(const CorotatedModel& model);
TissueLog make_tissue_log(const QuadraticModel& model);

/// At `state`, which was reached by a step of dt_s >= 0.
TissueMeasures measure(const CorotatedModel& model, const CorotatedState& state,
                       const DamageLimits& limits, double dt_s, TissueLog& log) noexcept;
TissueMeasures measure(const QuadraticModel& model, const QuadraticState& state,
                       const DamageLimits& limits, double dt_s, TissueLog& log) noexcept;

} // namespace tissue

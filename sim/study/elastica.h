// sim/study/elastica.h
// A straight cantilever that bends without stretching, under an end load that keeps its direction:
// how far its tip goes, by elliptic integrals (Bisshopp & Drucker 1945). Called by studies; pure.
#pragma once

namespace sim {

/// Of the length, but for the angle.
struct Elastica {
    double deflection = 0.0; // along the load
    double shortening = 0.0; // across it
    double angle_rad = 0.0;  // of the end
};

/// `alpha` = P L^2/(E I), from 0 to 1000. To 1e-12 of the length. Throws std::invalid_argument
/// naming another alpha.
Elastica elastica(double alpha);

} // namespace sim

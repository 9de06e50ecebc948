#include "assets/bake/edge_for_nodes.h"

#include <algorithm>
#include <cmath>

namespace bake {

double nodes_for_edge(double volume_m3, double area_m2, double edge_m) {
    const double h = edge_m;
    return area_m2 / (0.5 * std::sqrt(3.0) * h * h) +
           std::max(0.0, volume_m3 - 0.5 * h * area_m2) * std::sqrt(2.0) / (h * h * h);
}

double edge_for_nodes(double volume_m3, double area_m2, double nodes) {
    double low = 1e-5, high = 1.0; // the count falls with the edge
    for (int i = 0; i < 60; ++i) {
        const double middle = std::sqrt(low * high);
        (nodes_for_edge(volume_m3, area_m2, middle) > nodes ? low : high) = middle;
    }
    return high;
}

} // namespace bake

// assets/bake/edge_for_nodes.h
// From a number of nodes to the edge that gives it, and back. Called by bake and import.
#pragma once

namespace bake {

/// Nodes of even triangles on the area, sqrt(3)/2 h^2 each, and of even tetrahedra in what lies
/// deeper than half an edge, h^3 / sqrt(2) each.
double nodes_for_edge(double volume_m3, double area_m2, double edge_m);

/// The edge at which that is `nodes`.
double edge_for_nodes(double volume_m3, double area_m2, double nodes);

} // namespace bake

// assets/bake/import/soup.h
// Triangles as a file has them, before anything is checked: what the readers give and `clean`
// takes.
#pragma once

#include "tissue/mesh/tet_mesh.h"

#include <glm/vec3.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace bake {

/// Points in the file's own unit, finite; corners are indices of points. Nothing else is promised:
/// points may be doubled, triangles may be flat, doubled, flipped or cross each other.
struct Soup {
    std::string format; // "binary STL", ...
    std::vector<glm::dvec3> point;
    std::vector<tissue::Triangle> triangles;
    std::vector<std::string> remarks; // what the reader left out
};

/// The bytes are not what their format asks for. The message begins with the line or byte and says
/// what would be accepted; the caller adds the file's name.
struct ReadError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

} // namespace bake

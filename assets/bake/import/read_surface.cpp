#include "assets/bake/import/read_surface.h"

#include "assets/bake/import/text_scan.h"

namespace bake {
namespace {

bool ends_with(const std::string& name, std::string_view end) {
    return name.size() >= end.size() &&
           same_word(std::string_view(name).substr(name.size() - end.size()), end);
}

} // namespace

Soup read_surface(std::span<const std::byte> bytes, const std::string& file_name) {
    if (bytes.empty()) {
        throw ReadError("byte 0: the file is empty: accepted: STL, OBJ, PLY or OFF");
    }
    Soup soup;
    if (ends_with(file_name, ".stl")) {
        soup = read_stl(bytes);
    } else if (ends_with(file_name, ".obj")) {
        soup = read_obj(bytes);
    } else if (ends_with(file_name, ".ply")) {
        soup = read_ply(bytes);
    } else if (ends_with(file_name, ".off")) {
        soup = read_off(bytes);
    } else {
        throw ReadError("the end of its name says no known format: accepted: .stl, .obj, .ply, "
                        ".off");
    }
    check_count(soup);
    return soup;
}

} // namespace bake

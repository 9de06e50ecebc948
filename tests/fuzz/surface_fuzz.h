// tests/fuzz/surface_fuzz.h
// libFuzzer on a reader of surface files (clang only): refusing is fine; a crash, a leak, more
// memory than the bytes pay for, or a corner without a point is a finding. One program for each
// format, built and run by tests/fuzz/run.
#pragma once

#include "assets/bake/import/read_surface.h"

#include <cstdlib>

namespace fuzz {

template <class Reader> int read(Reader reader, const std::uint8_t* data, std::size_t size) {
    try {
        const bake::Soup soup = reader(std::as_bytes(std::span(data, size)));
        if (soup.triangles.size() > 4 * size || soup.point.size() > size)
            std::abort();
        for (const auto& t : soup.triangles) {
            for (const auto corner : t) {
                if (corner >= soup.point.size())
                    std::abort();
            }
        }
    } catch (const bake::ReadError&) {
    }
    return 0;
}

} // namespace fuzz

// tests/fuzz/off_fuzz.cpp
// The OFF reader; see surface_fuzz.h.
#include "tests/fuzz/surface_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return fuzz::read(bake::read_off, data, size);
}

// tests/fuzz/obj_fuzz.cpp
// The OBJ reader; see surface_fuzz.h.
#include "tests/fuzz/surface_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return fuzz::read(bake::read_obj, data, size);
}

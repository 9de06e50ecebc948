// tests/tissue/allocations.h
// How often this program has called operator new: for tests of code that must not allocate.
#pragma once

#include <cstddef>

namespace bodies {
std::size_t allocations() noexcept;
} // namespace bodies

// tests/tissue/allocations.cpp
// Replaces operator new by one that counts.
#include "tests/tissue/allocations.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::size_t> count{0};
} // namespace

namespace bodies {
std::size_t allocations() noexcept {
    return count.load();
}
} // namespace bodies

void* operator new(std::size_t size) {
    ++count;
    if (void* p = std::malloc(size > 0 ? size : 1))
        return p;
    throw std::bad_alloc();
}
// std::stable_sort asks for its buffer this way and gives it back to the same delete
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    ++count;
    return std::malloc(size > 0 ? size : 1);
}
void operator delete(void* p) noexcept {
    std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
    std::free(p);
}

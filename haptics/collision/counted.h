// haptics/collision/counted.h
// How much work a query is: a method that wears this counts what it looks at. Studies only; a
// method counts for a look that can count and costs nothing for one that cannot.
#pragma once

#include "haptics/collision/reach.h"

#include <cstdint>
#include <type_traits>

namespace haptics {

struct VisitCounts {
    std::uint64_t triangles = 0, boxes = 0, cells = 0;
};

template <class Look> void count_box(Look& look) noexcept {
    if constexpr (requires { look.counts.boxes; })
        ++look.counts.boxes;
}

template <class Look> void count_cell(Look& look) noexcept {
    if constexpr (requires { look.counts.cells; })
        ++look.counts.cells;
}

template <class Method> struct Counted {
    const Method& method;
    VisitCounts& counts; // written by visit: one thread
};

template <class Look> struct CountingLook {
    Look& look;
    VisitCounts& counts;
    void operator()(std::uint32_t triangle) {
        ++counts.triangles;
        look(triangle);
    }
};

template <class Method, class Look>
void visit(const Counted<Method>& counted, Reach& reach, Look&& look) {
    CountingLook<std::remove_reference_t<Look>> counting{look, counted.counts};
    visit(counted.method, reach, counting);
}

} // namespace haptics

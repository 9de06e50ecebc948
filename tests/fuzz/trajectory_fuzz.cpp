// tests/fuzz/trajectory_fuzz.cpp
// libFuzzer on the trajectory reader (clang only): refusing is fine; a crash, a leak, more memory
// than the bytes pay for, or samples that are out of order or not finite are a finding. Built and
// run by tests/fuzz/run.
#include "sim/io/trajectory_file.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const auto path = sim::read_trajectory(std::as_bytes(std::span(data, size)), "path.csv");
        if (path.empty() || path.size() > size)
            std::abort();
        for (std::size_t i = 0; i < path.size(); ++i) {
            const auto& [t, p] = path[i];
            for (const double value : {t, p.x, p.y, p.z})
                if (!std::isfinite(value))
                    std::abort();
            if (i > 0 && !(t > path[i - 1].time_s))
                std::abort();
        }
        if (path.back().time_s - path.front().time_s < 1.0)
            (void)sim::at_ticks(path);
    } catch (const std::runtime_error&) {
    }
    return 0;
}

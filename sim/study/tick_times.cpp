#include "sim/study/tick_times.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sys/resource.h>
#include <unistd.h>

namespace sim {
namespace {

double at_share(const std::vector<double>& sorted, double share) {
    const double rank = std::ceil(share * static_cast<double>(sorted.size()));
    return sorted[std::max<std::size_t>(1, static_cast<std::size_t>(rank)) - 1];
}

long involuntary_switches() {
#if defined(RUSAGE_THREAD)
    rusage usage{};
    if (getrusage(RUSAGE_THREAD, &usage) == 0)
        return usage.ru_nivcsw;
#endif
    return 0;
}

} // namespace

PreemptionWatch::PreemptionWatch() : switches_(involuntary_switches()) {}

bool PreemptionWatch::preempted(double ns) noexcept {
    if (ns < 1e5)
        return false;
    const long before = switches_;
    switches_ = involuntary_switches();
    return switches_ != before;
}

TickClock::TickClock() {
    using Steady = std::chrono::steady_clock;
    const auto began = Steady::now();
    const std::uint64_t from = start();
    while (Steady::now() - began < std::chrono::milliseconds(20)) {
    }
    const std::uint64_t to = stop();
    const auto lasted = std::chrono::duration<double, std::nano>(Steady::now() - began).count();
    ns_per_count_ = lasted / static_cast<double>(to - from);
    std::vector<double> empty(1001);
    for (double& e : empty) {
        const std::uint64_t a = start();
        e = ns(a, stop());
    }
    overhead_ns_ = tick_times(std::move(empty)).p50_ns;
}

TickTimes tick_times(std::vector<double> ns) {
    TickTimes out{.n = ns.size()};
    if (ns.empty())
        return out;
    std::sort(ns.begin(), ns.end());
    out.mean_ns = std::accumulate(ns.begin(), ns.end(), 0.0) / static_cast<double>(ns.size());
    out.p50_ns = at_share(ns, 0.5);
    out.p99_ns = at_share(ns, 0.99);
    out.p9999_ns = at_share(ns, 0.9999);
    out.max_ns = ns.back();
    return out;
}

CacheEvictor::CacheEvictor() {
    long last_level = 0;
#if defined(_SC_LEVEL3_CACHE_SIZE)
    last_level = sysconf(_SC_LEVEL3_CACHE_SIZE);
#endif
    buffer_.resize(last_level > 0 ? 2 * static_cast<std::size_t>(last_level) : 64u << 20);
}

void CacheEvictor::evict() noexcept {
    constexpr std::size_t kLine = 64;
    volatile unsigned char* const bytes = buffer_.data();
    for (std::size_t i = 0; i < buffer_.size(); i += kLine)
        bytes[i] = static_cast<unsigned char>(bytes[i] + 1);
}

} // namespace sim

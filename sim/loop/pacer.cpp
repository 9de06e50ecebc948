#include "sim/loop/pacer.h"

#include <ctime>
#include <pthread.h>
#include <sched.h>

namespace sim {
namespace {

std::int64_t now_ns() noexcept {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

} // namespace

Pacer::Pacer(double period_s) noexcept
    : period_ns_(static_cast<std::int64_t>(period_s * 1e9)), next_ns_(now_ns() + period_ns_) {}

void Pacer::wait() noexcept {
    const timespec until{static_cast<time_t>(next_ns_ / 1'000'000'000),
                         static_cast<long>(next_ns_ % 1'000'000'000)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) != 0) {
    }
    const std::int64_t late = now_ns() - next_ns_;
    if (late >= period_ns_) {
        missed_ += static_cast<std::uint64_t>(late / period_ns_);
        next_ns_ += late;
    }
    next_ns_ += period_ns_;
}

bool raise_priority(int priority) noexcept {
    const sched_param param{.sched_priority = priority};
    return pthread_setschedparam(pthread_self(), SCHED_FIFO, &param) == 0;
}

} // namespace sim

#include "sim/io/guard.h"

#include <csignal>
#include <initializer_list>

namespace sim {
namespace {

volatile std::sig_atomic_t stop_asked = 0;

extern "C" void on_signal(int signal_number) {
    if (stop_asked) {
        std::signal(signal_number, SIG_DFL);
        std::raise(signal_number);
    }
    stop_asked = 1;
}

} // namespace

void install_signal_guard() {
    for (const int s : {SIGINT, SIGTERM, SIGHUP})
        std::signal(s, on_signal);
}

bool asked_to_stop() {
    return stop_asked != 0;
}

} // namespace sim

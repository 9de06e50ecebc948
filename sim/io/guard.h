// sim/io/guard.h
// Ctrl-C and kill end a run in order: forces to zero, log closed. The handler only sets a flag.
#pragma once

namespace sim {

/// Installs handlers for INT, TERM and HUP. A second signal ends the process at once.
void install_signal_guard();
bool asked_to_stop();

} // namespace sim

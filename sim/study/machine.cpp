#include "sim/study/machine.h"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <unistd.h>

namespace sim {

std::string machine() {
    std::string model = "unknown processor";
    std::ifstream in("/proc/cpuinfo");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("model name")) {
            model = line.substr(std::min(line.find(':') + 2, line.size()));
            break;
        }
    return fmt::format("{}, {} processors", model, sysconf(_SC_NPROCESSORS_ONLN));
}

} // namespace sim

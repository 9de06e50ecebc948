// sim/view/cues.cpp
#include "sim/view/cues.h"

#include <algorithm>

namespace view {

Cues Listener::hear(const ViewFrame& frame) noexcept {
    const auto is_done = [](const TargetView& t) { return t.state == TargetState::done; };
    const auto done =
        static_cast<int>(std::count_if(frame.targets.begin(), frame.targets.end(), is_done));
    Cues cues;
    cues.error = known_ && frame.errors > errors_;
    cues.success = known_ && done > done_;
    for (std::size_t t = 0; t < touching_.size(); ++t) {
        const bool now = frame.tools[t].present && frame.tools[t].touching;
        cues.contact = cues.contact || (known_ && now && !touching_[t]);
        touching_[t] = now;
    }
    errors_ = frame.errors;
    done_ = done;
    known_ = true;
    return cues;
}

} // namespace view

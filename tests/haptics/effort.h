// tests/haptics/effort.h
// How many random cases to try. A sanitizer makes each ten times as slow and looks for other
// faults than rare ones: a tenth of the cases then.
#pragma once

namespace effort {

#ifdef TROCAR_SANITIZED
inline constexpr int kShare = 10;
#else
inline constexpr int kShare = 1;
#endif

constexpr int cases(int all) {
    return all / kShare;
}

} // namespace effort

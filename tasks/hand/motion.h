// tasks/hand/motion.h
// What hands are made of: one planned movement, tremor, and pressing to a force that is felt.
// Called by Hand and ScriptHand in every tick; no allocation after set-up.
#pragma once

#include "tasks/exercise/observation.h"
#include "tasks/hand/random.h"
#include "tasks/hand/skill.h"

#include <cstddef>
#include <vector>

namespace tasks {

/// One movement of minimum jerk (Flash & Hogan 1985): x(s) = 10 s^3 - 15 s^4 + 6 s^5, peak speed
/// 1.875 length/duration; the line is bent by `bow_m` at half-way.
struct MinimumJerk {
    glm::dvec3 from_m{0.0}, to_m{0.0}, bow_m{0.0};
    double duration_s = 0.0;
    double time_s = 0.0; // advances with the movement; may be held back
};
/// Share of the way done, 0..1.
double way_share(const MinimumJerk& move) noexcept;
glm::dvec3 place_m(const MinimumJerk& move) noexcept;
inline bool arrived(const MinimumJerk& move) noexcept {
    return move.time_s >= move.duration_s;
}
/// Straight movement with that peak speed, no quicker than any movement of a hand.
MinimumJerk plan_move(const glm::dvec3& from_m, const glm::dvec3& to_m, double peak_mps) noexcept;

/// The same with the spread of its end point: smaller for short movements (Harris & Wolpert 1998),
/// larger along the unit line of sight, because the picture is flat.
MinimumJerk aimed_move(const HandSkill& skill, Random& random, const glm::dvec3& from_m,
                       const glm::dvec3& to_m, const glm::dvec3& sight_line) noexcept;

/// Band-pass noise 3-12 Hz, `rms_m` long (three axes together).
struct Tremor {
    Random random;
    std::array<glm::dvec3, 2> state{}; // of the filter
};
glm::dvec3 next_tremor_m(Tremor& tremor, double rms_m) noexcept;

/// Advances along a line until a force is felt (late) and then holds it. The rate follows the
/// missing force through the stiffness felt so far, slow enough for the delay to be harmless:
/// rate = (1/e) / (k (delay + lag)) (wanted - felt), the gain of critical damping with dead time.
struct Press {
    double wanted_n = 0.0;
    double speed_mps = 0.0; // bound of the rate
    double delay_s = 0.0;
    double advanced_m = 0.0;
    double felt_n = 0.0;    // as late as the hand feels it
    double touched_m = 0.0; // advance at the first felt contact
    int contact_ticks = 0;  // since then; 0: nothing felt yet
    double rate_mps = 0.0;
    struct Past {
        double force_n = 0.0, advanced_m = 0.0;
    };
    std::vector<Past> past; // ring, one entry a tick
    std::size_t at = 0;
};
Press begin_press(double wanted_n, double speed_mps, double delay_s);
/// One millisecond with the true force of now; moves `advanced_m`.
void advance(Press& press, double force_n) noexcept;

inline constexpr double kContactFelt_n = 0.02; // finest force a finger tells from none

} // namespace tasks

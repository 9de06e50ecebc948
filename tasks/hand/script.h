// tasks/hand/script.h
// Scripted attempts as data: steps that are performed exactly (no noise) and what the metrics
// must be afterwards. `trocar run EXERCISE --hands FILE.toml`. Parsed at set-up, ticked by sim as
// a Hand is; not inside the 1 kHz budget.
//
//   [[step]]            tool = "left|right|assist" (every verb but wait), verb, and for
//     move              target or at_mm, seconds       to that tip place; target: 10 mm above it
//     touch             target, force_n, seconds       move above, press, hold until it counts or
//                                                      the seconds are over, retract
//     press             force_n, target, seconds       until that force is felt: against the
//                                                      target's normal, or along the shaft
//     hold              seconds, force_n               keeps pressing, or still; a force given
//                                                      here is the one to press with from now on
//     slide             target or at_mm, seconds       draws straight to there while it presses on
//     retract           seconds                        15 mm back the way it pressed
//     wait              seconds                        all tools go on as they are
//     grasp             seconds                        closes the jaws, in 0.3 s if not said
//     release           seconds                        opens them
//     look              target or at_mm, distance_mm,  (no tool) the endoscope: straight at that
//                       seconds, horizon_deg           place, from there, the picture so turned
//   [[expect]]          metric = "path_length", min, max (one or both)
#pragma once

#include "tasks/hand/motion.h"
#include "tasks/hand/sight.h"
#include "tasks/logbook/junit.h"
#include "tasks/score/metrics.h"

#include <optional>

namespace tasks {

enum class Verb : std::uint8_t {
    move,
    touch,
    press,
    hold,
    retract,
    wait,
    grasp,
    release,
    slide,
    look
};

struct ScriptStep {
    Verb verb = Verb::wait;
    Role tool = Role::right;
    std::string target;             // id; empty: none
    std::optional<glm::dvec3> at_m; // tip centre, world
    std::optional<double> force_n;
    std::optional<double> seconds;
    double distance_m = 0.0, horizon_rad = 0.0; // look
    std::string where;                          // "file:line" for messages
};

struct Expectation {
    std::string metric;
    std::optional<double> min, max; // inclusive
};

struct Script {
    std::vector<ScriptStep> step;
    std::vector<Expectation> expect;
};

/// The script moves the endoscope, which no assistant holds then.
bool holds_scope(const Script& script) noexcept;

/// Throws std::invalid_argument with file, line, key, value and what would be accepted.
Script parse_script(std::string_view text, std::string_view file);

/// An absent metric fails; the message says what was seen.
ExpectationResult check(const Expectation& expected, std::span<const Metric> metrics);

/// Performs a script. After its last step the tools stay where they are.
class ScriptHand {
  public:
    /// Throws std::invalid_argument for a target that the exercise does not have.
    ScriptHand(Script script, const Exercise& exercise,
               const std::array<glm::dvec3, kTools>& start_tip_m);
    HandGoals tick(const HandSight& sight);

  private:
    enum class Stage { begin, travel, press, back };
    bool perform(const HandSight& sight, const ScriptStep& step); // true: step is over
    bool follow();
    void begin_move(const glm::dvec3& to_m, const ScriptStep& step);
    void begin_pressing(const HandSight& sight, const ScriptStep& step);
    void keep_pressing(const HandSight& sight);
    bool touch(const HandSight& sight, const ScriptStep& step);
    bool slide(const HandSight& sight, const ScriptStep& step);
    bool move_jaw(const ScriptStep& step, double to);
    bool look(const HandSight& sight, const ScriptStep& step);

    Script script_;
    Exercise exercise_;
    std::vector<int> target_of_step_; // index into the exercise; -1: none
    std::size_t now_ = 0;             // step
    Stage stage_ = Stage::begin;
    double elapsed_s_ = 0.0; // of this step
    std::array<glm::dvec3, kTools> goal_m_;
    std::array<double, kTools> jaw_{}; // 0 open .. 1 closed
    double jaw_from_ = 0.0;
    ScopeGoal scope_, scope_from_;
    MinimumJerk move_;
    glm::dvec3 slide_from_m_{0.0}, slide_to_m_{0.0}; // of where the press began
    struct Pressing {
        bool active = false;
        glm::dvec3 from_m{0.0}, direction{0.0, 0.0, -1.0}; // direction: into the tissue
        Press press;
    };
    std::array<Pressing, kTools> pressing_;
};

} // namespace tasks

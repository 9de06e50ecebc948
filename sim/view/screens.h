// sim/view/screens.h
// What the screens around the picture say: menu, instruction card, score. Plain data, filled by
// the train command, drawn by Window::draw(). All texts UTF-8 in Latin-1's range.
#pragma once

#include "sim/view/frame.h"

#include <string>
#include <vector>

namespace view {

enum class Screen { menu, card, demo, run, paused, score, replay };

struct MenuExercise {
    std::string title;
    std::string hands;   // which roles it needs, in words
    std::string summary; // one line
};

struct MenuModel {
    std::vector<MenuExercise> exercises;
    std::vector<std::string> trainees; // names or ids
    int trainee = -1;                  // chosen one; -1: nobody, kept without a name
    std::string devices;               // what moves the tools, in words
};

struct CardModel {
    std::string title;
    std::string text;                // instructions, wrapped here
    std::vector<Role> roles;         // that it uses
    std::vector<std::string> limits; // "Force 0.1 to 1.0 N", one per line
    bool demo_available = true;
};

struct ScoreMetric {
    std::string name;
    double value = 0.0;
    std::string unit;
    bool lower_is_better = true;
    bool directed = true; // false: neither way is better, no arrow
    bool felt = true;     // false: reads "not felt"
    int decimals = 2;
};

struct ScoreError {
    double time_s = 0.0;
    std::string text;
};

/// One metric against the levels of its exercise.
struct ProfileBar {
    enum class Mark { good, pass, missed, not_judged };
    std::string name, value, limit; // "Time", "47.2 s", "at most 49.5 s"
    std::string word;               // what the mark means: "expert level", "missed"
    Mark mark = Mark::not_judged;
    double share = 0.0;                        // length, longer is better
    double pass_share = 0.5, good_share = 0.9; // where the marks of both levels stand
};

/// A moment worth seeing again.
struct ScoreMoment {
    double time_s = 0.0;
    std::string text;
};

struct ScoreModel {
    std::string title; // exercise and trainee
    bool completed = false;
    bool valid = true;
    std::vector<std::string> invalid_reasons;
    std::vector<ScoreMetric> metrics;
    std::vector<ScoreError> errors;
    std::vector<ProfileBar> profile;
    std::vector<ScoreMoment> moments; // each with a button if moments_can_be_shown
    bool moments_can_be_shown = false;
    std::string saved; // where it was kept, in words; empty: nowhere
};

struct Screens {
    Screen screen = Screen::menu;
    MenuModel menu;
    CardModel card;
    ScoreModel score;
};

} // namespace view

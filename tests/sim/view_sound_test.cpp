// tests/sim/view_sound_test.cpp
// What sounds when, and how it sounds, without a loudspeaker.
#include "sim/view/input.h"
#include "sim/view/sound.h"
#include "sim/view/tones.h"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

using namespace view;

namespace {

bool silent(const Cues& cues) {
    return !cues.contact && !cues.error && !cues.success;
}

} // namespace

TEST_CASE("A touch, an error and a target sound once, when they come, and none at the beginning") {
    Listener listener;
    ViewFrame frame;
    frame.targets.resize(2);
    frame.tools[1].present = frame.tools[1].touching = true;
    frame.errors = 3;
    CHECK(silent(listener.hear(frame)));
    frame.tools[2].present = frame.tools[2].touching = true;
    CHECK(listener.hear(frame).contact);
    CHECK(silent(listener.hear(frame)));
    frame.errors = 4;
    CHECK(listener.hear(frame).error);
    frame.targets[0].state = TargetState::done;
    const Cues done = listener.hear(frame);
    CHECK(done.success);
    CHECK_FALSE(done.error);
    frame.tools[2].touching = false; // letting go is silent
    CHECK(silent(listener.hear(frame)));
    listener.forget();
    frame.errors = 9;
    CHECK(silent(listener.hear(frame)));
}

TEST_CASE("No tone clicks: all begin and end in silence, and none is louder than 1") {
    const std::vector<float> all = mixed({.contact = true, .error = true, .success = true});
    for (const std::vector<float>& sound : {contact_tone(), error_tone(), success_tone(), all}) {
        CHECK(std::abs(sound.front()) < 1e-3F);
        CHECK(std::abs(sound.back()) < 1e-3F);
        CHECK(sound.size() < static_cast<std::size_t>(kSampleRate_hz) / 2);
        const float loudest =
            *std::max_element(sound.begin(), sound.end(), [](float a, float b) { return a < b; });
        CHECK(loudest > 0.05F);
        CHECK(loudest <= 1.0F);
    }
    CHECK(mixed({}).empty());
    CHECK(mixed({.contact = true}) == contact_tone());
}

TEST_CASE("Without a loudspeaker nothing sounds and nothing fails") {
    setenv("SDL_AUDIODRIVER", "none of that name", 1);
    Speaker speaker(true, false);
    speaker.play({.error = true});
    unsetenv("SDL_AUDIODRIVER");
    CHECK_FALSE(speaker.muted());
    speaker.toggle();
    CHECK(speaker.muted());
}

TEST_CASE("M turns the sound off and on, on every screen") {
    KeyFrame keys;
    keys.press(Key::m);
    for (const Screen screen :
         {Screen::menu, Screen::card, Screen::demo, Screen::run, Screen::paused, Screen::score}) {
        CHECK(map_keys(keys, screen).toggle_sound);
        CHECK(map_keys(keys, screen).action == Action::none);
    }
}

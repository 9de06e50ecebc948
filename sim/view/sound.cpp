// sim/view/sound.cpp
#include "sim/view/sound.h"

#include "sim/view/tones.h"

#include <cstdlib>
#include <filesystem>
#include <string>

#define SDL_MAIN_HANDLED
#include <SDL.h>

namespace view {
namespace {

/// Asked first because ALSA complains on the terminal where there is nothing to open.
bool may_sound() {
    if (std::getenv("SDL_AUDIODRIVER") != nullptr || std::getenv("PULSE_SERVER") != nullptr)
        return true;
    std::error_code none;
    if (const char* const run = std::getenv("XDG_RUNTIME_DIR"))
        for (const char* const server : {"pulse/native", "pipewire-0"})
            if (std::filesystem::exists(std::filesystem::path(run) / server, none))
                return true;
    for (const auto& card : std::filesystem::directory_iterator("/dev/snd", none))
        if (card.path().filename().string().starts_with("pcm"))
            return true;
    return false;
}

} // namespace

Speaker::Speaker(bool wanted, bool muted) : muted_(muted) {
    if (!wanted || !may_sound())
        return;
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1"); // Ctrl+C is ours
    opened_ = SDL_InitSubSystem(SDL_INIT_AUDIO) == 0;
    if (!opened_)
        return;
    SDL_AudioSpec spec{};
    spec.freq = kSampleRate_hz;
    spec.format = AUDIO_F32SYS;
    spec.channels = 1;
    spec.samples = 512; // 12 ms
    device_ = SDL_OpenAudioDevice(nullptr, 0, &spec, nullptr, 0);
    if (device_ != 0)
        SDL_PauseAudioDevice(device_, 0);
}

Speaker::~Speaker() {
    if (device_ != 0)
        SDL_CloseAudioDevice(device_);
    if (opened_)
        SDL_QuitSubSystem(SDL_INIT_AUDIO);
}

void Speaker::play(const Cues& cues) {
    if (device_ == 0 || muted_)
        return;
    const std::vector<float> sound = mixed(cues);
    if (sound.empty())
        return;
    SDL_ClearQueuedAudio(device_);
    SDL_QueueAudio(device_, sound.data(), static_cast<Uint32>(sound.size() * sizeof(float)));
}

} // namespace view

// See the header.
#include "sim/study/auto_model.h"

#include "sim/io/files.h"
#include "sim/study/why_study.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace sim {
namespace {

using Json = nlohmann::ordered_json;

// Of the program itself: what another build chose was measured on another step.
std::string build_hash() {
    try {
        const std::string program = read_text("/proc/self/exe");
        return sha256_hex(std::as_bytes(std::span(program)));
    } catch (const std::exception&) {
        return TROCAR_VERSION;
    }
}

std::string key_of(const RunOptions& options, bool choose_rate, const std::string& scene) {
    const LoadedScene loaded = load_scene(scene);
    const std::string exercise = read_text(find_exercise(loaded.place, options.exercise));
    const std::string all =
        fmt::format("{}\n{}\n{} {}\n{}", build_hash(), loaded.hash, options.fem_hz,
                    choose_rate ? "at most" : "exactly", exercise);
    return sha256_hex(std::as_bytes(std::span(all)));
}

// What was remembered before, or an empty object: memory that is damaged is begun anew.
Json recall(const std::filesystem::path& memory, void (*say)(const std::string&)) {
    if (!std::filesystem::exists(memory))
        return Json::object();
    try {
        Json all = Json::parse(read_text(memory));
        if (all.is_object())
            return all;
        say(fmt::format("{}: not an object of JSON; begun anew", memory.string()));
    } catch (const std::exception& e) {
        say(fmt::format("{}: begun anew: {}", memory.string(), e.what()));
    }
    return Json::object();
}

bool is_choice(const Json& all, const std::string& key) {
    return all.contains(key) && all[key].is_object() && all[key].contains("model") &&
           all[key]["model"].is_string() && all[key].contains("why") &&
           all[key]["why"].is_string() && all[key].contains("fem_hz") &&
           all[key]["fem_hz"].is_number_integer();
}

} // namespace

AutoModel auto_model(const RunOptions& options, bool choose_rate,
                     const std::filesystem::path& memory, void (*say)(const std::string&)) {
    const std::string scene = options.scene.empty() ? scene_for(options.exercise) : options.scene;
    const std::string key = key_of(options, choose_rate, scene);
    Json all = recall(memory, say);
    if (is_choice(all, key))
        return {all[key]["model"], all[key]["why"], all[key]["fem_hz"], true};
    WhyOptions why;
    why.scene = scene;
    why.exercise = {options.exercise};
    why.fem_hz = options.fem_hz;
    why.choose_rate = choose_rate;
    const WhyStudy study = run_why_study(why, say);
    AutoModel made{study.model, why_words(study), study.rate.hz, false};
    all[key] = {{"scene", study.scene},
                {"exercise", options.exercise},
                {"model", made.model},
                {"fem_hz", made.fem_hz},
                {"why", made.why}};
    try {
        write_text(memory, all.dump(1));
    } catch (const std::exception& e) {
        say(fmt::format("{}: not remembered: {}", memory.string(), e.what()));
    }
    return made;
}

std::filesystem::path model_memory() {
    return user_data_dir() / "models.json";
}

} // namespace sim

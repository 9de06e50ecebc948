// See the header.
#include "sim/session/model_choice.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>
#include <string_view>

namespace sim {
namespace {

// What was wrong with `text`, and all that --model accepts.
[[noreturn]] void refuse(const std::string& text, const std::string& what) {
    throw std::invalid_argument(
        fmt::format("model \"{}\": {}; accepted: auto, or one of {} for every organ, or "
                    "ORGAN=MODEL[,ORGAN=MODEL..] for some of them, alone or after that one",
                    text, what, fmt::join(tissue::kTierNames, ", ")));
}

tissue::Tier tier_in(std::string_view word, const std::string& text) {
    const auto tier = tissue::tier_named(word);
    if (!tier)
        refuse(text, fmt::format("\"{}\" is no model", word));
    return *tier;
}

} // namespace

ModelChoice parse_model(const std::string& text, std::span<const std::string> organ) {
    ModelChoice choice(organ.size(), kUsualTier);
    std::string_view rest = text;
    for (bool first = true; first || !rest.empty(); first = false) {
        const std::size_t comma = rest.find(',');
        const std::string_view part = rest.substr(0, comma);
        rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
        const std::size_t equals = part.find('=');
        if (equals == std::string_view::npos) {
            if (!first)
                refuse(text, fmt::format("\"{}\" after a comma names no organ", part));
            std::fill(choice.begin(), choice.end(), tier_in(part, text));
            continue;
        }
        const auto named = std::find(organ.begin(), organ.end(), part.substr(0, equals));
        if (named == organ.end()) {
            refuse(text, fmt::format("no organ \"{}\", the scene has {}", part.substr(0, equals),
                                     fmt::join(organ, ", ")));
        }
        choice[static_cast<std::size_t>(named - organ.begin())] =
            tier_in(part.substr(equals + 1), text);
    }
    return choice;
}

std::string model_text(const ModelChoice& choice, std::span<const std::string> organ,
                       const std::vector<bool>& soft) {
    std::array<int, tissue::kTierNames.size()> count{};
    for (std::size_t i = 0; i < choice.size(); ++i) {
        if (soft[i])
            ++count[static_cast<std::size_t>(choice[i])];
    }
    const auto most =
        static_cast<tissue::Tier>(std::max_element(count.begin(), count.end()) - count.begin());
    const bool none = count[static_cast<std::size_t>(most)] == 0;
    std::string text(tissue::name_of(none ? kUsualTier : most));
    for (std::size_t i = 0; i < choice.size(); ++i) {
        if (soft[i] && choice[i] != most)
            text += fmt::format(",{}={}", organ[i], tissue::name_of(choice[i]));
    }
    return text;
}

} // namespace sim

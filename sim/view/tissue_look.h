// sim/view/tissue_look.h
// What tissue looks like, by one word. The words stand in scene files; the picture knows what each
// means. Nothing but words: read by scene files and by the view.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace view {

enum class Look : std::uint8_t {
    liver,
    stomach,
    spleen,
    kidney,
    bowel,
    pancreas,
    fat,
    gallbladder,
    artery,
    vein,
    duct,
    wall,
    tissue // anything else
};

/// In the order of Look.
inline constexpr std::array<std::string_view, 13> kLookWords{
    "liver",       "stomach", "spleen", "kidney", "bowel", "pancreas", "fat",
    "gallbladder", "artery",  "vein",   "duct",   "wall",  "tissue"};

/// The look of that name; tissue if it is no such word.
constexpr Look look_named(std::string_view word) noexcept {
    const auto found = std::find(kLookWords.begin(), kLookWords.end(), word);
    return found == kLookWords.end() ? Look::tissue : static_cast<Look>(found - kLookWords.begin());
}

} // namespace view

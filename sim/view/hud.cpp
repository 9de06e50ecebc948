// sim/view/hud.cpp
// Drawn straight into the background list: nothing here takes the pointer or the keyboard.
#include "sim/view/hud.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace view {
namespace {

struct Pen {
    ImDrawList& list;
    const Fonts& fonts;
    float em, width, height; // body text height and window, pixels

    /// Large letters in a small window: what stands side by side goes below one another.
    bool narrow() const { return width < 42.0F * em; }
};

void panel(const Pen& pen, ImVec2 from, ImVec2 to) {
    pen.list.AddRectFilled(from, to, ink::panel, 6.0F);
}

void centred(const Pen& pen, ImFont* font, float x, float y, ImU32 colour, std::string_view text) {
    draw_text(pen.list, font, {x - 0.5F * text_size(font, text).x, y}, colour, text);
}

void draw_clock(const Pen& pen, const ViewFrame& frame) {
    const float em = pen.em;
    panel(pen, {em, em}, {em + 9.5F * em, em + 2.6F * em});
    draw_text(pen.list, pen.fonts.title, {1.5F * em, 1.15F * em}, ink::text,
              clock_text(frame.time_s));
    if (frame.time_limit_s > 0.0)
        draw_text(pen.list, pen.fonts.body, {7.2F * em, 1.85F * em}, ink::quiet,
                  "/ " + clock_text(frame.time_limit_s).substr(0, 4));
}

void draw_next(const Pen& pen, const ViewFrame& frame) {
    const float em = pen.em, x = 0.5F * pen.width, half = 8.0F * em;
    const float top = pen.narrow() ? 4.0F * em : em;
    const auto is_next = [](const TargetView& t) { return t.state == TargetState::next; };
    const auto next = std::find_if(frame.targets.begin(), frame.targets.end(), is_next);
    const auto done = std::count_if(frame.targets.begin(), frame.targets.end(),
                                    [](const auto& t) { return t.state == TargetState::done; });
    panel(pen, {x - half, top}, {x + half, top + 2.6F * em});
    if (next == frame.targets.end()) {
        centred(pen, pen.fonts.large, x, top + 0.6F * em, ink::text,
                frame.targets.empty() ? "" : "All targets done");
        return;
    }
    draw_badge(pen.list, {x - half + 1.8F * em, top + 1.3F * em}, 0.95F * em, next->role,
               fmt::format("{}", next->number));
    draw_text(pen.list, pen.fonts.large, {x - half + 3.4F * em, top + 0.6F * em}, ink::text,
              fmt::format("{} tool", role_word(next->role)));
    const std::string share = frame.path.place_m.empty()
                                  ? fmt::format("{} / {}", done, frame.targets.size())
                                  : fmt::format("{:.0f} %", 100.0 * frame.path.done);
    draw_text(pen.list, pen.fonts.body,
              {x + half - 0.8F * em - text_size(pen.fonts.body, share).x, top + 0.8F * em},
              ink::quiet, share);
}

void draw_counters(const Pen& pen, const ViewFrame& frame) {
    const float em = pen.em, right = pen.width - em,
                left = right - (pen.narrow() ? 9.0F : 11.0F) * em;
    panel(pen, {left, em}, {right, 3.6F * em});
    const ImU32 colour = frame.errors > 0 ? ink::warn : ink::text;
    draw_text(pen.list, pen.fonts.large, {left + 0.7F * em, 1.6F * em}, colour,
              fmt::format("Errors {}", frame.errors));
    const ImVec2 dot(right - (pen.narrow() ? 1.0F : 3.7F) * em, 2.3F * em);
    if (frame.recorder == Recorder::off)
        return;
    const bool fault = frame.recorder == Recorder::fault;
    pen.list.AddCircleFilled(dot, 0.38F * em, fault ? ink::warn : ink::bad, 20);
    if (!pen.narrow())
        draw_text(pen.list, pen.fonts.body, {dot.x + 0.7F * em, dot.y - 0.6F * em},
                  fault ? ink::warn : ink::quiet, fault ? "REC !" : "REC");
}

/// The bar spans 0 .. 1.25 limit: band in green, limit as a red mark, the force as a fill.
void draw_bar(const Pen& pen, const ToolView& tool, const ForceLimits& limits, ImVec2 from,
              float width) {
    const float tall = 0.75F * pen.em;
    const double full_n = 1.25 * std::max({limits.limit_n, limits.band_max_n, 1e-3});
    const auto x_of = [&](double n) {
        return from.x + width * static_cast<float>(std::clamp(n / full_n, 0.0, 1.0));
    };
    const double n = glm::length(tool.force_n);
    const bool over = n > limits.limit_n, inside = n >= limits.band_min_n && n <= limits.band_max_n;
    pen.list.AddRectFilled(from, {from.x + width, from.y + tall}, ink::track, 3.0F);
    pen.list.AddRectFilled({x_of(limits.band_min_n), from.y},
                           {x_of(limits.band_max_n), from.y + tall}, IM_COL32(52, 110, 62, 255));
    const ImU32 fill = over ? ink::bad : inside ? ink::good : IM_COL32(214, 216, 218, 255);
    pen.list.AddRectFilled({from.x, from.y + 0.22F * tall}, {x_of(n), from.y + 0.78F * tall}, fill,
                           2.0F);
    const float mark = x_of(limits.limit_n);
    pen.list.AddLine({mark, from.y - 0.2F * pen.em}, {mark, from.y + tall + 0.2F * pen.em},
                     ink::bad, 2.5F);
    for (const double edge : {limits.band_min_n, limits.band_max_n})
        pen.list.AddLine({x_of(edge), from.y}, {x_of(edge), from.y + tall}, ink::good, 1.5F);
}

std::string holder(const ViewFrame& frame, const ToolView& tool) {
    if (tool.faulted)
        return "device fault";
    if (tool.assistant)
        return "assistant";
    if (!frame.felt || !frame.forces_on)
        return "not felt"; // the frame already says which tool is yours
    return tool.active ? "you" : "";
}

void draw_force(const Pen& pen, const ViewFrame& frame, const ToolView& tool, ImVec2 from,
                ImVec2 to) {
    const float em = pen.em;
    panel(pen, from, to);
    if (tool.active)
        pen.list.AddRect(from, to, role_ink(tool.role), 6.0F, 0, 2.5F);
    draw_badge(pen.list, {from.x + 1.6F * em, from.y + 1.9F * em}, 0.9F * em, tool.role,
               role_letter(tool.role));
    if (tool.touching) // what the tick says to the ear
        pen.list.AddCircle({from.x + 1.6F * em, from.y + 1.9F * em}, 1.35F * em, ink::text, 32,
                           0.12F * em);
    const float left = from.x + 3.1F * em, right = to.x - 0.9F * em;
    const std::string value = fmt::format("{:.2f} N", glm::length(tool.force_n));
    const bool over = glm::length(tool.force_n) > frame.force.limit_n;
    draw_text(pen.list, pen.fonts.large,
              {right - text_size(pen.fonts.large, value).x, from.y + 0.35F * em},
              over ? ink::bad : ink::text, value);
    const bool below = right - left < 10.0F * em; // no room beside the number
    draw_text(pen.list, pen.fonts.body, {left, from.y + (below ? 2.0F : 0.6F) * em},
              tool.faulted ? ink::bad : ink::quiet, holder(frame, tool));
    draw_bar(pen, tool, frame.force, {left, to.y - 1.35F * em}, right - left);
}

void draw_forces(const Pen& pen, const ViewFrame& frame) {
    const float em = pen.em, gap = 0.8F * em, bottom = pen.height - 2.5F * em;
    const auto here =
        std::count_if(frame.tools.begin(), frame.tools.end(), [](auto& t) { return t.present; });
    const float most = (pen.width - 2.0F * em + gap) / 3.0F - gap;
    const float wide = std::min(most, 19.0F * em);
    const float tall = wide < 14.0F * em ? 5.1F * em : 3.7F * em;
    float x = 0.5F * (pen.width - static_cast<float>(here) * (wide + gap) + gap);
    for (const ToolView& tool : frame.tools) {
        if (!tool.present)
            continue;
        draw_force(pen, frame, tool, {x, bottom - tall}, {x + wide, bottom});
        x += wide + gap;
    }
}

void draw_messages(const Pen& pen, const ViewFrame& frame, float top_em) {
    const float em = pen.em;
    float y = top_em * em;
    constexpr std::size_t kShown = 4;
    const std::size_t n = frame.messages.size();
    for (std::size_t i = n > kShown ? n - kShown : 0; i < n; ++i) {
        const char* const text = frame.messages[i].c_str();
        const float wrap = pen.width - 3.2F * em, px = pen.fonts.body->FontSize;
        const ImVec2 size = pen.fonts.body->CalcTextSizeA(px, wrap, wrap, text);
        panel(pen, {em, y}, {2.2F * em + size.x, y + 0.5F * em + size.y});
        pen.list.AddText(pen.fonts.body, px, {1.6F * em, y + 0.25F * em}, ink::warn, text, nullptr,
                         wrap);
        y += 0.8F * em + size.y;
    }
    if (frame.forces_on)
        return;
    constexpr std::string_view text = "Forces are off.  F: on again";
    ImFont* const font = pen.narrow() ? pen.fonts.large : pen.fonts.title;
    const ImVec2 size = text_size(font, text);
    const float x = 0.5F * pen.width, top = pen.height - (pen.narrow() ? 10.6F : 9.6F) * em;
    panel(pen, {x - 0.5F * size.x - em, top}, {x + 0.5F * size.x + em, top + 2.8F * em});
    centred(pen, font, x, top + 1.4F * em - 0.5F * size.y, ink::warn, text);
}

void draw_foot(const Pen& pen, Screen screen) {
    const float em = pen.em, line = pen.height - 1.55F * em;
    pen.list.AddRectFilled({0.0F, pen.height - 1.85F * em}, {pen.width, pen.height}, ink::panel);
    const std::string_view keys =
        screen == Screen::replay ? "Backspace back to score"
        : pen.narrow()           ? "P pause   Esc forces off"
        : screen == Screen::demo ? "P pause   Backspace end   M sound   Esc forces off"
        : pen.width < 66.0F * em
            ? "P pause   Tab tool   Esc forces off"
            : "P pause   Tab next tool   W A S D Q E move   Space jaw   M sound   Esc forces off";
    const std::string_view notice =
        pen.narrow() ? "Not a medical device." : "For training. Not a medical device.";
    draw_text(pen.list, pen.fonts.body, {em, line}, ink::quiet, keys);
    draw_text(pen.list, pen.fonts.body,
              {pen.width - em - text_size(pen.fonts.body, notice).x, line}, ink::quiet, notice);
}

} // namespace

std::string clock_text(double seconds) {
    const auto tenths = static_cast<long long>(std::floor(std::max(0.0, seconds) * 10.0 + 1e-6));
    return fmt::format("{}:{:02}.{}", tenths / 600, tenths / 10 % 60, tenths % 10);
}

void draw_hud(const ViewFrame& frame, Screen screen, const Fonts& fonts) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    const Pen pen{*ImGui::GetBackgroundDrawList(), fonts, fonts.body->FontSize, window.x, window.y};
    draw_clock(pen, frame);
    draw_next(pen, frame);
    draw_counters(pen, frame);
    draw_forces(pen, frame);
    const float top_em = pen.narrow() ? 3.0F : 0.0F; // the next target stands in a second row
    const bool shown = screen == Screen::demo || screen == Screen::replay;
    const char* word = screen == Screen::demo ? "Demonstration" : "Replay";
    draw_messages(pen, frame, shown && !pen.narrow() ? 7.2F : 4.3F + top_em);
    draw_foot(pen, screen);
    if (shown && pen.narrow()) // between the clock and the counters
        centred(pen, fonts.body, 0.5F * (pen.width + 0.5F * pen.em), 1.8F * pen.em, ink::warn,
                word);
    else if (shown)
        centred(pen, fonts.title, 0.5F * pen.width, 4.2F * pen.em, ink::warn, word);
}

} // namespace view

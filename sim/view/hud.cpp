// sim/view/hud.cpp
// Drawn straight into the background list: nothing here takes the pointer or the keyboard. Panels
// are in hud_instruments.cpp.
#include "sim/view/hud.h"

#include "sim/view/hud_parts.h"
#include "sim/view/lens.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace view {
namespace {

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

/// Two lines at most beside the badge, in the middle of the panel's height.
void draw_hint(const Pen& pen, float left, float right, float top, const std::string& hint) {
    ImFont* const font = pen.fonts.body;
    const float tall =
        font->CalcTextSizeA(font->FontSize, right - left, right - left, hint.c_str()).y;
    pen.list.AddText(font, font->FontSize, {left, top + 1.3F * pen.em - 0.5F * tall}, ink::text,
                     hint.c_str(), nullptr, right - left);
}

void draw_next(const Pen& pen, const ViewFrame& frame) {
    const float em = pen.em, x = 0.5F * pen.width;
    const float half = frame.hint.empty() ? 8.0F * em : 11.5F * em;
    const float top = pen.narrow() ? 4.0F * em : em;
    const auto is_next = [](const TargetView& t) { return t.state == TargetState::next; };
    const auto next = std::find_if(frame.targets.begin(), frame.targets.end(), is_next);
    const auto is_done = [](const TargetView& t) { return t.state == TargetState::done; };
    const auto done = std::count_if(frame.targets.begin(), frame.targets.end(), is_done);
    const auto all = std::count_if(frame.targets.begin(), frame.targets.end(),
                                   [](const TargetView& t) { return !t.lift; });
    panel(pen, {x - half, top}, {x + half, top + 2.6F * em});
    if (next == frame.targets.end()) {
        centred(pen, pen.fonts.large, x, top + 0.6F * em, ink::text,
                frame.targets.empty() ? "" : "All targets done");
        return;
    }
    draw_badge(pen.list, {x - half + 1.8F * em, top + 1.3F * em}, 0.95F * em, next->role,
               next->lift ? role_letter(next->role) : fmt::format("{}", next->number));
    const std::string share = frame.path.place_m.empty()
                                  ? fmt::format("{} / {}", done, all)
                                  : fmt::format("{:.0f} %", 100.0 * frame.path.done);
    const float right = x + half - 0.8F * em - text_size(pen.fonts.body, share).x;
    if (frame.hint.empty())
        draw_text(pen.list, pen.fonts.large, {x - half + 3.4F * em, top + 0.6F * em}, ink::text,
                  role_name(next->role));
    else
        draw_hint(pen, x - half + 3.4F * em, right - 0.5F * em, top, frame.hint);
    draw_text(pen.list, pen.fonts.body, {right, top + 0.8F * em}, ink::quiet, share);
}

/// What counts is within it. Dark beside light, so that it reads on any tissue.
void draw_ring(const Pen& pen, const ViewFrame& frame) {
    if (!(frame.ring_share > 0.0))
        return;
    const Lens lens = lens_of(static_cast<int>(pen.width), static_cast<int>(pen.height));
    const ImVec2 middle(0.5F * pen.width, 0.5F * pen.height);
    const float radius = middle.y * static_cast<float>(seen_radius(lens, 2.0 * frame.ring_share));
    pen.list.AddCircle(middle, radius, IM_COL32(0, 0, 0, 120), 96, 3.5F);
    pen.list.AddCircle(middle, radius, IM_COL32(255, 255, 255, 170), 96, 1.5F);
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
    const float above_em = !pen.narrow() ? 9.6F : frame.scope.present ? 13.6F : 10.6F;
    const float x = 0.5F * pen.width, top = pen.height - above_em * em;
    panel(pen, {x - 0.5F * size.x - em, top}, {x + 0.5F * size.x + em, top + 2.8F * em});
    centred(pen, font, x, top + 1.4F * em - 0.5F * size.y, ink::warn, text);
}

void draw_foot(const Pen& pen, const ViewFrame& frame, Screen screen) {
    const float em = pen.em, line = pen.height - 1.55F * em;
    pen.list.AddRectFilled({0.0F, pen.height - 1.85F * em}, {pen.width, pen.height}, ink::panel);
    const std::string_view keys =
        screen == Screen::replay ? "Backspace back to score"
        : pen.narrow()           ? "P pause   Esc forces off"
        : screen == Screen::demo ? "P pause   Backspace end   M sound   Esc forces off"
        : pen.width < 66.0F * em ? "P pause   Tab tool   Esc forces off"
        : frame.scope.active
            ? "P pause   Tab next tool   W A S D look   Q E in, out   R T camera   Z X optic   "
              "Esc forces off"
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
    draw_ring(pen, frame);
    draw_clock(pen, frame);
    draw_next(pen, frame);
    draw_counters(pen, frame);
    draw_instruments(pen, frame);
    const float top_em = pen.narrow() ? 3.0F : 0.0F; // the next target stands in a second row
    const bool shown = screen == Screen::demo || screen == Screen::replay;
    const char* word = screen == Screen::demo ? "Demonstration" : "Replay";
    draw_messages(pen, frame, shown && !pen.narrow() ? 7.2F : 4.3F + top_em);
    draw_foot(pen, frame, screen);
    if (shown && pen.narrow()) // between the clock and the counters
        centred(pen, fonts.body, 0.5F * (pen.width + 0.5F * pen.em), 1.8F * pen.em, ink::warn,
                word);
    else if (shown)
        centred(pen, fonts.title, 0.5F * pen.width, 4.2F * pen.em, ink::warn, word);
}

} // namespace view

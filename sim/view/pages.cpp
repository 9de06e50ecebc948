// sim/view/pages.cpp
// One panel in the middle of the window per page, never larger than the window: it scrolls.
#include "sim/view/pages.h"

#include "sim/view/page_parts.h"
#include "sim/view/score_page.h"

#include <algorithm>

namespace view {
namespace {

constexpr ImGuiWindowFlags kPanel = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoCollapse;

} // namespace

void begin_panel(const char* name, float wide, float tall, bool fresh) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    const float em = ImGui::GetFontSize();
    const ImVec2 size(std::min(wide * em, window.x - 2.0F * em),
                      std::min(tall * em, window.y - 4.5F * em));
    ImGui::SetNextWindowPos({0.5F * window.x, 0.5F * window.y - 0.4F * em}, ImGuiCond_Always,
                            {0.5F, 0.5F});
    ImGui::SetNextWindowSize(size);
    if (fresh)
        ImGui::SetNextWindowFocus();
    ImGui::Begin(name, nullptr, kPanel);
}

void heading(const Fonts& fonts, const std::string& text) {
    ImGui::PushFont(fonts.title);
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::PopFont();
}

void quiet(const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, ink::quiet);
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::PopStyleColor();
}

bool is_narrow() {
    return ImGui::GetWindowWidth() < 40.0F * ImGui::GetFontSize();
}

void bullet(const std::string& text) {
    ImGui::Bullet();
    ImGui::TextWrapped("%s", text.c_str());
}

bool button(const Fonts& fonts, const char* label, bool first, float wide) {
    const float em = ImGui::GetFontSize();
    const bool narrow = is_narrow();
    ImGui::PushFont(narrow ? fonts.body : fonts.large);
    const bool pressed = ImGui::Button(label, {narrow ? 0.0F : wide * em, 0.0F});
    ImGui::PopFont();
    if (first)
        ImGui::SetItemDefaultFocus();
    return pressed;
}

namespace {

bool exercise_entry(const Fonts& fonts, const MenuExercise& exercise, int index) {
    const float em = ImGui::GetFontSize();
    ImGui::PushID(index);
    const ImVec2 at = ImGui::GetCursorPos();
    const float wrap = ImGui::GetContentRegionAvail().x - 2.0F * em;
    const float summary = ImGui::CalcTextSize(exercise.summary.c_str(), nullptr, false, wrap).y;
    const bool pressed = ImGui::Button("##open", {-1.0F, 3.6F * em + summary});
    if (index == 0)
        ImGui::SetItemDefaultFocus();
    const ImVec2 after = ImGui::GetCursorPos();
    ImGui::SetCursorPos({at.x + em, at.y + 0.5F * em});
    ImGui::PushFont(fonts.large);
    ImGui::TextUnformatted(exercise.title.c_str());
    ImGui::PopFont();
    ImGui::SetCursorPos({at.x + em, at.y + 2.0F * em});
    ImGui::PushTextWrapPos(at.x + em + wrap);
    ImGui::TextUnformatted(exercise.summary.c_str());
    ImGui::PopTextWrapPos();
    ImGui::SetCursorPos({at.x + em, at.y + 2.2F * em + summary});
    ImGui::TextDisabled("%s", exercise.hands.c_str());
    ImGui::SetCursorPos(after);
    ImGui::PopID();
    return pressed;
}

void trainee_choice(const MenuModel& menu, UserInput& input) {
    const auto name = [&](int i) {
        return i < 0 ? "nobody (kept without a name)" : menu.trainees[i].c_str();
    };
    const int chosen = menu.trainee < static_cast<int>(menu.trainees.size()) ? menu.trainee : -1;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("Trainee");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1.0F);
    if (!ImGui::BeginCombo("##trainee", name(chosen)))
        return;
    for (int i = -1; i < static_cast<int>(menu.trainees.size()); ++i) {
        ImGui::PushID(i);
        if (ImGui::Selectable(name(i), i == chosen)) {
            input.action = Action::choose_trainee;
            input.index = i;
        }
        ImGui::PopID();
    }
    ImGui::EndCombo();
}

void draw_menu(const MenuModel& menu, const Fonts& fonts, bool fresh, UserInput& input) {
    begin_panel("menu", 44.0F, 38.0F, fresh);
    heading(fonts, "Trocar");
    quiet("Laparoscopic basic skills. For training, not for credentialing. Not a medical device.");
    ImGui::Spacing();
    trainee_choice(menu, input);
    ImGui::Spacing();
    for (int i = 0; i < static_cast<int>(menu.exercises.size()); ++i)
        if (exercise_entry(fonts, menu.exercises[i], i)) {
            input.action = Action::select;
            input.index = i;
        }
    ImGui::Spacing();
    if (!menu.devices.empty())
        quiet(menu.devices);
    if (button(fonts, "Quit", menu.exercises.empty(), 8.0F))
        input.action = Action::quit;
    ImGui::SameLine();
    quiet("Arrow keys and Enter choose.  Ctrl + and Ctrl - change the size of the text.");
    ImGui::End();
}

/// Side by side, as many as there is room for.
void draw_roles(const std::vector<Role>& roles, const Fonts& fonts) {
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float em = ImGui::GetFontSize(), wide = ImGui::GetContentRegionAvail().x;
    const float apart = 9.0F * em;
    const int columns = std::max(1, static_cast<int>(wide / apart));
    int at = 0;
    for (const Role role : roles) {
        const ImVec2 place(from.x + apart * static_cast<float>(at % columns),
                           from.y + 1.8F * em * static_cast<float>(at / columns));
        ImDrawList& list = *ImGui::GetWindowDrawList();
        draw_badge(list, {place.x + em, place.y + 0.9F * em}, 0.72F * em, role, role_letter(role));
        draw_text(list, fonts.body, {place.x + 2.2F * em, place.y + 0.4F * em}, ink::text,
                  role_name(role));
        ++at;
    }
    const int rows = (at + columns - 1) / columns;
    ImGui::Dummy({wide, 1.8F * em * static_cast<float>(rows)});
}

void draw_card(const CardModel& card, const Fonts& fonts, bool fresh, UserInput& input) {
    begin_panel("card", 42.0F, 28.0F, fresh);
    heading(fonts, card.title);
    ImGui::Spacing();
    const float em = ImGui::GetFontSize();
    ImGui::BeginChild("words", {0.0F, -3.4F * em});
    ImGui::PushFont(is_narrow() ? fonts.body : fonts.large);
    ImGui::TextWrapped("%s", card.text.c_str());
    ImGui::PopFont();
    ImGui::Spacing();
    draw_roles(card.roles, fonts);
    ImGui::Spacing();
    for (const std::string& limit : card.limits)
        bullet(limit);
    ImGui::Spacing();
    quiet(
        "Mouse and keys: Tab changes the tool, W A S D Q E or the mouse move it, Space or the left "
        "button closes its jaws. Jaws that close on tissue hold it until they open; closed jaws "
        "stay closed when Tab goes on, until Space is pressed and released there again.");
    quiet("Endoscope, where the scene has one: mouse or W A S D turn the view, wheel or Q E go in "
          "and "
          "out, R T turn the camera head, Z X the optic.");
    if (std::find(card.roles.begin(), card.roles.end(), Role::scope) != card.roles.end())
        quiet("What you do not hold is held for you.");
    ImGui::EndChild();
    if (button(fonts, "Start", true))
        input.action = Action::start;
    ImGui::SameLine();
    if (card.demo_available) {
        if (button(fonts, "Demonstration (D)", false, 15.0F))
            input.action = Action::demo;
        ImGui::SameLine();
    }
    if (button(fonts, "Back (Esc)", false))
        input.action = Action::back;
    ImGui::End();
}

void draw_pause(const Fonts& fonts, bool fresh, UserInput& input) {
    begin_panel("paused", 30.0F, 12.5F, fresh);
    heading(fonts, "Paused");
    ImGui::TextWrapped("Every device is limp. The pause is kept in the logbook.");
    ImGui::Spacing();
    if (button(fonts, "Go on (P)", true, 18.0F))
        input.action = Action::resume;
    if (button(fonts, "Abandon (Backspace)", false, 18.0F))
        input.action = Action::abandon;
    ImGui::End();
}

} // namespace

void draw_page(const Screens& screens, const Fonts& fonts, bool fresh, UserInput& input) {
    switch (screens.screen) {
    case Screen::menu:
        return draw_menu(screens.menu, fonts, fresh, input);
    case Screen::card:
        return draw_card(screens.card, fonts, fresh, input);
    case Screen::paused:
        return draw_pause(fonts, fresh, input);
    case Screen::score:
        return draw_score(screens.score, fonts, fresh, input);
    case Screen::run:
    case Screen::demo:
    case Screen::replay:
        return;
    }
}

} // namespace view

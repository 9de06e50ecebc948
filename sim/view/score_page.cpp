#include "sim/view/score_page.h"

#include "sim/view/hud.h"
#include "sim/view/page_parts.h"

#include <algorithm>

#include <fmt/format.h>

namespace view {
namespace {

using Mark = ProfileBar::Mark;

ImU32 ink_of(Mark mark) {
    switch (mark) {
    case Mark::good:
    case Mark::pass:
        return ink::good;
    case Mark::missed:
        return ink::bad;
    case Mark::not_judged:
        break;
    }
    return ink::quiet;
}

/// Two ticks, one tick, a cross, a dash: told apart without colour.
void draw_mark(ImDrawList& list, ImVec2 c, float r, Mark mark) {
    const ImU32 colour = ink_of(mark);
    const float thick = 0.28F * r;
    const auto tick = [&](float x) {
        const ImVec2 line[]{
            {x - 0.8F * r, c.y}, {x - 0.2F * r, c.y + 0.7F * r}, {x + 0.9F * r, c.y - 0.8F * r}};
        list.AddPolyline(line, 3, colour, 0, thick);
    };
    switch (mark) {
    case Mark::good:
        tick(c.x - 0.5F * r);
        return tick(c.x + 0.6F * r);
    case Mark::pass:
        return tick(c.x);
    case Mark::missed:
        list.AddLine({c.x - 0.7F * r, c.y - 0.7F * r}, {c.x + 0.7F * r, c.y + 0.7F * r}, colour,
                     thick);
        return list.AddLine({c.x - 0.7F * r, c.y + 0.7F * r}, {c.x + 0.7F * r, c.y - 0.7F * r},
                            colour, thick);
    case Mark::not_judged:
        return list.AddLine({c.x - 0.7F * r, c.y}, {c.x + 0.7F * r, c.y}, colour, thick);
    }
}

void text_in(ImU32 colour, const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopStyleColor();
}

float bar_width() {
    return std::min(13.0F * ImGui::GetFontSize(), ImGui::GetContentRegionAvail().x);
}

/// The words over both levels' marks, once above all bars.
void bar_heads(const Fonts& fonts, const ProfileBar& bar) {
    const float width = bar_width();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (const auto& [share, word] :
         {std::pair(bar.pass_share, "pass"), std::pair(bar.good_share, "expert")}) {
        const float wide = text_size(fonts.body, word).x;
        const float x = std::min(width * static_cast<float>(share) - 0.5F * wide, width - wide);
        draw_text(list, fonts.body, {at.x + x, at.y}, ink::quiet, word);
    }
    ImGui::Dummy({width, ImGui::GetFontSize()});
}

void draw_bar(const ProfileBar& bar) {
    const float em = ImGui::GetFontSize(), tall = 0.8F * em, width = bar_width();
    ImVec2 at = ImGui::GetCursorScreenPos();
    at.y += 0.1F * em;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const auto x_of = [&](double share) { return at.x + width * static_cast<float>(share); };
    list.AddRectFilled(at, {at.x + width, at.y + tall}, ink::track, 3.0F);
    if (bar.share > 0.0)
        list.AddRectFilled({at.x, at.y + 0.15F * tall}, {x_of(bar.share), at.y + 0.85F * tall},
                           ink_of(bar.mark), 2.0F);
    for (const double share : {bar.pass_share, bar.good_share})
        list.AddLine({x_of(share), at.y - 0.1F * em}, {x_of(share), at.y + tall + 0.1F * em},
                     ink::text, share == bar.good_share ? 3.0F : 1.5F);
    ImGui::Dummy({width, em});
}

void mark_and_word(const ProfileBar& bar) {
    const float em = ImGui::GetFontSize();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    draw_mark(*ImGui::GetWindowDrawList(), {at.x + 0.7F * em, at.y + 0.5F * em}, 0.4F * em,
              bar.mark);
    ImGui::Dummy({1.4F * em, em});
    ImGui::SameLine();
    ImGui::PushStyleColor(ImGuiCol_Text, ink_of(bar.mark));
    ImGui::TextWrapped("%s", bar.word.c_str());
    ImGui::PopStyleColor();
}

/// Name, bar, value, mark and limit side by side; with large letters the bar goes below the name
/// and the limit below the value.
void profile_row(const ProfileBar& bar, bool narrow) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(bar.name.c_str());
    if (!narrow)
        ImGui::TableNextColumn();
    draw_bar(bar);
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(bar.value.c_str());
    if (narrow)
        quiet(bar.limit);
    ImGui::TableNextColumn();
    mark_and_word(bar);
    if (narrow)
        return;
    ImGui::TableNextColumn();
    text_in(ink::quiet, bar.limit);
}

constexpr ImGuiTableFlags kRows = ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit;

void draw_profile(const ScoreModel& score, const Fonts& fonts) {
    if (score.profile.empty())
        return;
    const float em = ImGui::GetFontSize();
    const bool narrow = ImGui::GetContentRegionAvail().x < 52.0F * em;
    const std::vector<float> columns =
        narrow ? std::vector{12.0F, 11.0F, 9.5F} : std::vector{10.5F, 13.5F, 6.5F, 8.5F, 12.0F};
    if (!ImGui::BeginTable("profile", static_cast<int>(columns.size()), kRows))
        return;
    for (const float wide : columns)
        ImGui::TableSetupColumn(
            "", narrow ? ImGuiTableColumnFlags_WidthStretch : ImGuiTableColumnFlags_WidthFixed,
            narrow ? wide : wide * em);
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    if (!narrow)
        ImGui::TableNextColumn();
    bar_heads(fonts, score.profile.front());
    for (const ProfileBar& bar : score.profile)
        profile_row(bar, narrow);
    ImGui::EndTable();
}

void draw_moments(const ScoreModel& score, const Fonts& fonts, UserInput& input) {
    if (score.moments.empty())
        return;
    const float em = ImGui::GetFontSize();
    ImGui::Spacing();
    ImGui::PushFont(fonts.large);
    ImGui::TextUnformatted("Worth seeing again");
    ImGui::PopFont();
    for (int i = 0; i < static_cast<int>(score.moments.size()); ++i) {
        ImGui::PushID(i);
        if (score.moments_can_be_shown) {
            if (ImGui::Button("Show me", {6.0F * em, 0.0F})) {
                input.action = Action::show;
                input.index = i;
            }
            ImGui::SameLine();
        }
        ImGui::AlignTextToFramePadding();
        text_in(ink::quiet, clock_text(score.moments[i].time_s));
        ImGui::SameLine(score.moments_can_be_shown ? 11.0F * em : 4.5F * em);
        ImGui::TextWrapped("%s", score.moments[i].text.c_str());
        ImGui::PopID();
    }
}

void metric_row(const ScoreMetric& metric) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextWrapped("%s", metric.name.c_str());
    ImGui::TableNextColumn();
    if (metric.felt)
        ImGui::TextWrapped(
            "%s", fmt::format("{:.{}f} {}", metric.value, metric.decimals, metric.unit).c_str());
    else
        quiet("not felt");
    ImGui::TableNextColumn();
    if (metric.directed)
        quiet(metric.lower_is_better ? "less is better" : "more is better");
}

void draw_numbers(const ScoreModel& score, const Fonts& fonts) {
    ImGui::Spacing();
    ImGui::PushFont(fonts.large);
    ImGui::TextUnformatted("All numbers");
    ImGui::PopFont();
    if (ImGui::BeginTable("metrics", 3, ImGuiTableFlags_RowBg)) {
        for (const float wide : {15.0F, 10.0F, 10.0F})
            ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch, wide);
        for (const ScoreMetric& metric : score.metrics)
            metric_row(metric);
        ImGui::EndTable();
    }
    ImGui::Spacing();
    ImGui::Text("Errors: %d", static_cast<int>(score.errors.size()));
    for (const ScoreError& error : score.errors)
        bullet(fmt::format("{:.1f} s  {}", error.time_s, error.text));
}

void draw_outcome(const ScoreModel& score) {
    text_in(score.completed ? ink::good : ink::warn,
            score.completed ? "Completed." : "Not completed: nothing is judged.");
    if (score.valid)
        return;
    ImGui::PushStyleColor(ImGuiCol_Text, ink::bad);
    ImGui::TextWrapped("Not valid: the rig was at fault, not the hands. Nothing is judged.");
    for (const std::string& reason : score.invalid_reasons)
        bullet(reason);
    ImGui::PopStyleColor();
}

} // namespace

void draw_score(const ScoreModel& score, const Fonts& fonts, bool fresh, UserInput& input) {
    begin_panel("score", 56.0F, 42.0F, fresh);
    heading(fonts, score.title);
    draw_outcome(score);
    const float em = ImGui::GetFontSize();
    // flattened: the arrow keys go from the buttons below into the moments' buttons
    const float room = std::max(ImGui::GetContentRegionAvail().y - 5.0F * em, 6.0F * em);
    ImGui::BeginChild("body", {0.0F, room}, false, ImGuiWindowFlags_NavFlattened);
    draw_profile(score, fonts);
    draw_moments(score, fonts, input);
    draw_numbers(score, fonts);
    ImGui::EndChild();
    quiet(score.saved.empty() ? "For training, not for credentialing."
                              : score.saved + "  For training, not for credentialing.");
    if (button(fonts, "Menu", true))
        input.action = Action::back;
    ImGui::SameLine();
    if (button(fonts, "Again", false))
        input.action = Action::start;
    ImGui::End();
}

} // namespace view

// sim/view/look.cpp
// Dark, quiet panels: the picture is the bright thing on the screen.
#include "sim/view/look.h"

#include "sim/view/tool_mesh.h"

#include <cstdio>
#include <filesystem>
#include <string>

#include <backends/imgui_impl_opengl3.h>

namespace view {
namespace {

constexpr const char* kFace = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

ImFont* add_face(ImFontAtlas& atlas, float px) {
    if (std::filesystem::exists(kFace))
        if (ImFont* face = atlas.AddFontFromFileTTF(kFace, px))
            return face;
    ImFontConfig config;
    config.SizePixels = px;
    return atlas.AddFontDefault(&config);
}

} // namespace

Fonts load_fonts(float body_px) {
    ImGuiIO& io = ImGui::GetIO();
    io.Fonts->Clear();
    Fonts fonts;
    fonts.body = add_face(*io.Fonts, std::round(body_px));
    fonts.large = add_face(*io.Fonts, std::round(1.35F * body_px));
    fonts.title = add_face(*io.Fonts, std::round(1.9F * body_px));
    io.Fonts->Build();
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
    return fonts;
}

Digits digits_of(const Fonts& fonts) {
    Digits digits;
    digits.texture = static_cast<GLuint>(
        reinterpret_cast<std::uintptr_t>(ImGui::GetIO().Fonts->TexID)); // as the backend made it
    for (std::size_t i = 0; i < digits.glyph.size(); ++i) {
        const ImFontGlyph* g = fonts.title->FindGlyph(static_cast<ImWchar>(kGlyphs[i]));
        const float tall = g->Y1 - g->Y0;
        digits.glyph[i] = {
            {g->U0, g->V1, g->U1, g->V0}, (g->X1 - g->X0) / tall, g->AdvanceX / tall};
    }
    return digits;
}

void set_look(float body_px) {
    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    style.WindowRounding = style.ChildRounding = 8.0F;
    style.FrameRounding = style.GrabRounding = 5.0F;
    style.WindowBorderSize = 0.0F;
    style.WindowPadding = {1.5F * body_px, 1.2F * body_px};
    style.FramePadding = {0.8F * body_px, 0.45F * body_px};
    style.ItemSpacing = {0.6F * body_px, 0.5F * body_px};
    ImVec4* c = style.Colors;
    c[ImGuiCol_WindowBg] = {0.065F, 0.078F, 0.092F, 0.96F};
    c[ImGuiCol_Text] = {0.93F, 0.93F, 0.92F, 1.0F};
    c[ImGuiCol_TextDisabled] = {0.69F, 0.71F, 0.73F, 1.0F};
    c[ImGuiCol_Button] = {0.16F, 0.22F, 0.27F, 1.0F};
    c[ImGuiCol_ButtonHovered] = {0.20F, 0.38F, 0.50F, 1.0F};
    c[ImGuiCol_ButtonActive] = {0.14F, 0.47F, 0.66F, 1.0F};
    c[ImGuiCol_Header] = c[ImGuiCol_Button];
    c[ImGuiCol_HeaderHovered] = c[ImGuiCol_ButtonHovered];
    c[ImGuiCol_HeaderActive] = c[ImGuiCol_ButtonActive];
    c[ImGuiCol_FrameBg] = {0.12F, 0.15F, 0.18F, 1.0F};
    c[ImGuiCol_NavHighlight] = {1.0F, 0.80F, 0.30F, 1.0F};
    ImGui::GetStyle() = style;
}

ImU32 role_ink(Role role, float alpha) {
    const glm::vec3 c = role_colour(role);
    return ImGui::ColorConvertFloat4ToU32({c.x, c.y, c.z, alpha});
}

const char* role_letter(Role role) {
    constexpr std::array<const char*, 4> kLetters{"L", "R", "A", "E"};
    return kLetters[static_cast<std::size_t>(role)];
}

const char* role_word(Role role) {
    constexpr std::array<const char*, 4> kWords{"left", "right", "assist", "endoscope"};
    return kWords[static_cast<std::size_t>(role)];
}

std::string role_name(Role role) {
    return role == Role::scope ? "endoscope" : std::string(role_word(role)) + " tool";
}

ImVec2 text_size(ImFont* font, std::string_view text) {
    return font->CalcTextSizeA(font->FontSize, 1e6F, 0.0F, text.data(), text.data() + text.size());
}

void draw_text(ImDrawList& list, ImFont* font, ImVec2 at, ImU32 colour, std::string_view text) {
    list.AddText(font, font->FontSize, at, colour, text.data(), text.data() + text.size());
}

void draw_badge(ImDrawList& list, ImVec2 centre, float radius_px, Role role,
                std::string_view text) {
    const float r = radius_px;
    const ImU32 fill = role_ink(role), line = IM_COL32(255, 255, 255, 235);
    ImVec2 middle = centre;
    if (role == Role::left) {
        list.AddCircleFilled(centre, r, fill, 32);
        list.AddCircle(centre, r, line, 32, 1.5F);
    } else if (role == Role::right) {
        const ImVec2 a(centre.x, centre.y - 1.15F * r),
            b(centre.x + 1.15F * r, centre.y + 0.85F * r),
            c(centre.x - 1.15F * r, centre.y + 0.85F * r);
        list.AddTriangleFilled(a, b, c, fill);
        list.AddTriangle(a, b, c, line, 1.5F);
        middle.y += 0.25F * r;
    } else if (role == Role::scope) {
        const float d = 1.25F * r;
        const ImVec2 a(centre.x, centre.y - d), b(centre.x + d, centre.y);
        const ImVec2 c(centre.x, centre.y + d), e(centre.x - d, centre.y);
        list.AddQuadFilled(a, b, c, e, fill);
        list.AddQuad(a, b, c, e, line, 1.5F);
    } else {
        const ImVec2 a(centre.x - 0.92F * r, centre.y - 0.92F * r),
            b(centre.x + 0.92F * r, centre.y + 0.92F * r);
        list.AddRectFilled(a, b, fill, 2.0F);
        list.AddRect(a, b, line, 2.0F, 0, 1.5F);
    }
    ImFont* font = ImGui::GetFont();
    const ImVec2 size = text_size(font, text);
    draw_text(list, font, {middle.x - 0.5F * size.x, middle.y - 0.5F * size.y},
              IM_COL32(255, 255, 255, 255), text);
}

} // namespace view

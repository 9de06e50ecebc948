// sim/view/shaders.cpp
// An endoscope's picture on a budget: the lamp sits at the camera, so its highlight looks back at
// it (half vector = direction to the eye), its light falls with the square of the distance and
// towards the rim. One or two fetches of noise per fragment carry colour, vessels and wetness.
#include "sim/view/shaders.h"

namespace view::shaders {

const char* const prelude = R"(#version 330 core
uniform vec3 eye_m;
uniform vec3 ahead;
uniform float lamp_size2_m2;
uniform float exposure;

// light at a place, as in light.h, times the camera's exposure
float lamp(vec3 place_m) {
    vec3 ray = place_m - eye_m;
    float d2 = dot(ray, ray);
    float along = max(dot(ray, ahead), 0.0);
    return exposure * along * along / max(d2, 1e-9) * (0.0256 + lamp_size2_m2) / (d2 + lamp_size2_m2);
}

// linear light to the screen: soft shoulder, then gamma 2
vec3 shown(vec3 light) {
    light = light / (1.0 + 0.35 * light);
    return sqrt(clamp(light, 0.0, 1.0));
}
)";

const char* const tissue_vertex = R"(
layout(location = 0) in vec3 position_m;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 rest_m;
layout(location = 3) in float open_sky;
uniform mat4 to_clip;
out vec3 place;
out vec3 outward;
out vec2 on_tile;
out float sky;
void main() {
    place = position_m;
    outward = normal;
    // slanted, so that no side of an organ that the camera sees is drawn out into streaks
    on_tile = rest_m.xy + rest_m.z * vec2(0.55, 0.75);
    sky = open_sky;
    gl_Position = to_clip * vec4(position_m, 1.0);
}
)";

const char* const tissue_fragment = R"(
in vec3 place;
in vec3 outward;
in vec2 on_tile;
in float sky;
uniform sampler2D noise;
uniform vec3 deep;    // tissue_style.h
uniform vec3 pale;
uniform vec3 vein;
uniform vec3 tiles;   // coarse, fine, share of the fine
uniform vec3 veins;   // large, small
uniform vec3 film_of; // wet, bumps
uniform int tools;    // how many of the following
uniform vec4 tip[3];  // centre, radius
uniform vec3 back[3]; // from tip to handle
out vec4 colour;

// how much of the sky a shaft hides from a surface point: n.w r/d, near its end n.w (r/d)^2
float hidden_by(int i, vec3 n) {
    vec3 from = place - tip[i].xyz;
    float along = clamp(dot(from, back[i]), 0.0, 0.15);
    vec3 w = along * back[i] - from;
    float d2 = max(dot(w, w), 1e-8);
    float r = 1.55 * tip[i].w;
    return clamp(dot(n, w) * inversesqrt(d2), 0.0, 1.0) * min(1.0, r * r / d2);
}

void main() {
    vec3 n = normalize(outward);
    vec3 to_eye = normalize(eye_m - place);
    vec4 coarse = texture(noise, on_tile * tiles.x);
    vec3 film = coarse.xyz - 0.5;
    float mottle = coarse.x;
    float blood = veins.x * coarse.w;
#ifdef FINE
    vec4 fine = texture(noise, on_tile.yx * tiles.y);
    film = 0.65 * film + 0.35 * (fine.xyz - 0.5);
    mottle = mix(mottle, fine.x, tiles.z);
    blood = max(blood, veins.y * fine.w);
#endif
    vec3 base = mix(deep, pale, clamp(2.0 * mottle - 0.5, 0.0, 1.0));
    base = mix(base, vein, blood);
    film = n + film_of.y * film; // a wet film: small waves turn the mirror, not the shade

    float open = 0.35 + 0.65 * sky;
#ifdef NEAR
    for (int i = 0; i < tools; ++i)
        open *= 1.0 - 0.85 * hidden_by(i, n);
#endif

    float facing = max(dot(n, to_eye), 0.0);
    float light = lamp(place) * open;
    float mirror = max(dot(film, to_eye) * inversesqrt(dot(film, film)), 0.0);
    float m2 = mirror * mirror;
    float m4 = m2 * m2;
    float m8 = m4 * m4;
    float m32 = m8 * m8 * m8 * m8;
    float m128 = m32 * m32 * m32 * m32;
    float away = 1.0 - facing;
    vec3 lit = base * (light * (2.6 * facing * (0.4 + 0.6 * facing) + 0.05));
    lit += base * vec3(0.45, 0.18, 0.135) * (light * away); // light inside the tissue
    lit += vec3(1.0, 0.93, 0.86) * (film_of.x * light * (1.5 * m128 * m128 + 0.25 * m32 + 0.06 * m8));
    lit += vec3(0.10, 0.05, 0.04) * (away * away * away * light);
    colour = vec4(shown(lit), 1.0);
}
)";

const char* const tool_vertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 to_clip;
uniform mat4 model;
out vec3 place;
out vec3 outward;
void main() {
    vec4 world = model * vec4(position, 1.0);
    place = world.xyz;
    outward = mat3(transpose(inverse(model))) * normal;
    gl_Position = to_clip * world;
}
)";

const char* const tool_fragment = R"(
in vec3 place;
in vec3 outward;
uniform vec3 base;
uniform float metal;         // 0 plastic, 1 steel
out vec4 colour;
void main() {
    vec3 n = normalize(outward);
    vec3 to_eye = normalize(eye_m - place);
    float facing = max(dot(n, to_eye), 0.0);
    float light = lamp(place);
    // steel shows the room: the lamp, red tissue below, darkness above
    vec3 r = reflect(-to_eye, n);
    float down = 0.5 - 0.5 * dot(r, -ahead);
    vec3 room = mix(vec3(0.10, 0.10, 0.11), vec3(0.30, 0.13, 0.10), smoothstep(0.2, 0.9, down));
    float f2 = facing * facing;
    float spot = pow(facing, 40.0);
    float band = pow(facing, 6.0);
    vec3 plastic = base * (1.9 * light * facing + 0.10) + vec3(0.35) * light * spot;
    vec3 steel = base * (room + vec3(0.75) * light * (0.25 * f2 + 0.75 * band)) +
                 vec3(1.0) * light * spot;
    colour = vec4(shown(mix(plastic, steel, metal)), 1.0);
}
)";

const char* const path_vertex = R"(
layout(location = 0) in vec3 place_m;
layout(location = 1) in vec2 on_path; // across -1..1, along in places
uniform mat4 to_clip;
uniform float lift_m;        // in depth only, as of targets
out vec2 at;
void main() {
    at = on_path;
    vec4 here = to_clip * vec4(place_m, 1.0);
    vec4 near = to_clip * vec4(place_m + lift_m * normalize(eye_m - place_m), 1.0);
    gl_Position = vec4(here.xy, near.z / near.w * here.w, here.w);
}
)";

const char* const path_fragment = R"(
in vec2 at;
uniform vec3 base;
uniform float done;          // in places
uniform float opacity;
out vec4 colour;
void main() {
    float px = max(fwidth(at.x), 1e-4);
    float side = abs(at.x);
    float line = 1.0 - smoothstep(0.20 - px, 0.20 + px, side);
    float halo = 1.0 - smoothstep(0.34 - px, 0.34 + px, side); // dark, so that it reads on any tissue
    float rim = smoothstep(0.90 - px, 0.90 + px, side) * 0.45;
    bool passed = at.y < done;
    vec3 drawn = passed ? vec3(0.62) : base;
    vec3 c = mix(vec3(0.05), drawn, max(line, rim > 0.0 ? 1.0 : 0.0));
    float a = max(max(line, 0.75 * halo), max(rim, 0.06)) * (passed ? 0.6 : 1.0);
    colour = vec4(c, a * opacity);
}
)";

const char* const target_vertex = R"(
uniform mat4 to_clip;
uniform vec3 centre_m;
uniform vec3 across_m;       // unit disc to world
uniform vec3 upward_m;
uniform float reach;         // half side of the square in disc radii
uniform float lift_m;        // nearer to the eye in depth only, so soft ground does not bury it
out vec2 at;
void main() {
    at = reach * (vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0);
    vec3 place = centre_m + at.x * across_m + at.y * upward_m;
    vec4 here = to_clip * vec4(place, 1.0);
    vec4 near = to_clip * vec4(place + lift_m * normalize(eye_m - place), 1.0);
    gl_Position = vec4(here.xy, near.z / near.w * here.w, here.w);
}
)";

const char* const target_fragment = R"(
in vec2 at;
uniform int shape;           // 0 circle, 1 triangle, 2 square
uniform int arrow;           // 1: two of them over the shape, upward
uniform vec3 base;
uniform vec3 ink;            // of the number
uniform float opacity;
uniform float ring;          // 0: none, else the pulse's radius
uniform float hold;          // 0..1
uniform vec4 glyph_uv[2];
uniform vec4 glyph_box[2];   // left, bottom, right, top in disc radii
uniform sampler2D font;
out vec4 colour;

float edge(vec2 p) {         // distance to the shape's edge, negative inside
    if (shape == 0)
        return length(p) - 1.0;
    if (shape == 2)
        return max(abs(p.x), abs(p.y)) - 0.90;
    return max(dot(vec2(abs(p.x), p.y), vec2(0.8660254, 0.5)), -p.y) - 0.80;
}

void main() {
    float px = max(length(vec2(dFdx(at.x), dFdy(at.x))), 1e-4);
    float d = edge(at);
    float inside = clamp(0.5 - d / px, 0.0, 1.0);
    float rim = 0.14 + px;
    float border = inside * clamp(0.5 + (d + rim) / px, 0.0, 1.0);
    vec4 sum = vec4(mix(base, vec3(1.0), border), inside);
    float text = 0.0;
    for (int i = 0; i < 2; ++i) {
        vec4 b = glyph_box[i];
        vec2 s = (at - b.xy) / max(b.zw - b.xy, vec2(1e-6));
        if (all(greaterThan(s, vec2(0.0))) && all(lessThan(s, vec2(1.0))))
            text += textureLod(font, mix(glyph_uv[i].xy, glyph_uv[i].zw, s), 0.0).a;
    }
    sum.rgb = mix(sum.rgb, ink, clamp(text, 0.0, 1.0));
    float r = length(at);
    if (ring > 0.0) {        // pulse, and the hold as an arc from twelve o'clock
        float wave = clamp(1.0 - abs(r - ring) / (0.07 + 0.7 * px), 0.0, 1.0);
        sum = mix(sum, vec4(1.0), wave * (1.0 - sum.a));
        float share = atan(-at.x, -at.y) / 6.2831853 + 0.5;
        float arc = clamp(1.0 - abs(r - 1.85) / (0.16 + 0.7 * px), 0.0, 1.0);
        sum = mix(sum, vec4(0.35, 1.0, 0.45, 1.0), hold > 0.0 && share <= hold ? arc : 0.0);
    }
    if (arrow == 1) {
        for (int i = 0; i < 2; ++i) {
            float y = at.y - (1.50 + 0.38 * float(i)) + 0.7 * abs(at.x);
            float stroke = clamp(1.0 - (abs(y) - 0.07) / (2.0 * px), 0.0, 1.0);
            sum = mix(sum, vec4(1.0), abs(at.x) < 0.62 ? stroke : 0.0);
        }
    }
    sum.a *= opacity;
    if (sum.a < 0.01)
        discard;
    colour = sum;
}
)";

const char* const lens_vertex = R"(
uniform float aspect;
out vec2 at; // half heights of the window, origin in the middle
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
    at = corner * vec2(aspect, 1.0);
    gl_Position = vec4(corner, 0.0, 1.0);
}
)";

const char* const lens_fragment = R"(
in vec2 at;
uniform sampler2D pinhole;
uniform float rim;    // lens.h
uniform float barrel;
uniform vec2 reach;
out vec4 colour;
void main() {
    float r2 = dot(at, at);
    vec3 seen = texture(pinhole, 0.5 + (0.5 + 0.5 * barrel * r2) * at / reach).rgb;
    float q = r2 / (rim * rim);
    float edge = clamp((1.0 - q) * 9.0, 0.0, 1.0); // dark over the last 6 % of the radius
    edge *= edge * (1.0 - 0.30 * q);
    colour = vec4(mix(vec3(0.012, 0.011, 0.012), seen, edge), 1.0);
}
)";

} // namespace view::shaders

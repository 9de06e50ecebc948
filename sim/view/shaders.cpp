// sim/view/shaders.cpp
// An endoscope's picture on a budget: the lamp sits at the camera, so its highlight looks back at
// it (half vector = direction to the eye), its light falls with the square of the distance and
// towards the rim. One or two fetches of noise per fragment carry colour and wetness.
#include "sim/view/shaders.h"

namespace view::shaders {

const char* const prelude = R"(#version 330 core
uniform vec3 eye_m;
uniform vec3 ahead;

// light at a place, 1 on the axis at 0.16 m: inverse square, softened near the lamp
float lamp(vec3 place_m) {
    vec3 ray = place_m - eye_m;
    float d = length(ray);
    float rim = clamp(dot(ray, ahead) / max(d, 1e-6), 0.0, 1.0);
    return rim * rim * 0.0306 / (d * d + 0.005);
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
uniform mat4 to_clip;
out vec3 place;
out vec3 outward;
out vec3 rest;
void main() {
    place = position_m;
    outward = normal;
    rest = rest_m;
    gl_Position = to_clip * vec4(position_m, 1.0);
}
)";

const char* const tissue_fragment = R"(
in vec3 place;
in vec3 outward;
in vec3 rest;
uniform sampler2D noise;
uniform vec4 tip[3]; // centre, radius; radius 0: no tool
uniform vec3 back[3]; // from tip to handle
out vec4 colour;

// how much of the sky a sphere hides from a surface point: n.w (r/d)^2
float hidden_by(int i, vec3 n) {
    vec3 from = place - tip[i].xyz;
    float along = clamp(dot(from, back[i]), 0.0, 0.07);
    vec3 w = along * back[i] - from;
    float d2 = max(dot(w, w), 1e-8);
    float r = 1.55 * tip[i].w;
    return clamp(dot(n, w) * inversesqrt(d2), 0.0, 1.0) * min(1.0, r * r / d2);
}

void main() {
    vec3 n = normalize(outward);
    vec3 to_eye = normalize(eye_m - place);
    if (dot(n, to_eye) < 0.0)
        n = -n;
    // slanted, so that no side of an organ that the camera sees is drawn out into streaks
    vec2 on_tile = rest.xy + rest.z * vec2(0.55, 0.75);
    vec4 coarse = texture(noise, on_tile * 5.0);

    // a wet film: small waves turn the mirror, not the shade
#ifndef WALL // parenchyma under serosa, lobules as fine mottle
    vec4 fine = texture(noise, on_tile * 29.0);
    float mottle = 0.6 * coarse.w + 0.4 * fine.w;
    vec3 base = mix(vec3(0.130, 0.016, 0.012), vec3(0.330, 0.062, 0.042), mottle);
    base = mix(base, vec3(0.40, 0.16, 0.10), 0.35 * smoothstep(0.58, 0.85, fine.z));
    vec3 film = n + 0.42 * (fine.xyz - 0.5) + 0.50 * (coarse.xyz - 0.5);
    const float wet = 0.60;
    float hidden = 1.0;
    for (int i = 0; i < 3; ++i)
        hidden *= 1.0 - 0.80 * hidden_by(i, n);
#else        // peritoneum over fat, vessels where two noises cross one half
    vec3 base = mix(vec3(0.42, 0.150, 0.105), vec3(0.56, 0.300, 0.175), coarse.w);
    float vessel = clamp(1.5 - 50.0 * abs(coarse.y - 0.5), 0.0, 1.0);
    vessel *= clamp(7.0 * coarse.x - 3.4, 0.0, 1.0);
    base = mix(base, vec3(0.28, 0.035, 0.035), 0.6 * vessel);
    vec3 film = n + 0.6 * (coarse.xyz - 0.5);
    const float wet = 0.12;
    const float hidden = 1.0;
#endif

    float facing = max(dot(n, to_eye), 0.0);
    float light = lamp(place);
    float mirror = max(dot(film, to_eye) * inversesqrt(dot(film, film)), 0.0);
    float m2 = mirror * mirror;
    float m4 = m2 * m2;
    float m8 = m4 * m4;
    float m32 = m8 * m8 * m8 * m8;
    float m128 = m32 * m32 * m32 * m32;
    float away = 1.0 - facing;
    vec3 lit = base * (2.6 * light * facing * (0.4 + 0.6 * facing) + 0.05);
    lit += base * vec3(1.0, 0.40, 0.30) * 0.45 * light * away; // light inside the tissue
    lit += vec3(1.0, 0.93, 0.86) * wet * light * (1.1 * m128 * m128 + 0.10 * m8);
    lit += vec3(0.10, 0.05, 0.04) * away * away * away * light;
    colour = vec4(shown(lit * hidden), 1.0);
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
    sum.a *= opacity;
    if (sum.a < 0.01)
        discard;
    colour = sum;
}
)";

} // namespace view::shaders

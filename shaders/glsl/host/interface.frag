#version 460
#extension GL_GOOGLE_include_directive : require
// Colours of a user interface. They are meant to be blended as they are encoded; a window that encodes what it is given
// blends decoded ones, which only shades edges a little otherwise.

#include "common/tone_map.glsl"

layout(location = 0) in vec2 place;
layout(location = 1) in vec4 tint;

layout(set = 0, binding = 0) uniform texture2D glyphs;
layout(set = 0, binding = 1) uniform sampler glyphs_sampler;

layout(push_constant) uniform Window {
    vec2 size;
    uint decoded;
} window;

layout(location = 0) out vec4 shown;

void main()
{
    shown = tint * texture(sampler2D(glyphs, glyphs_sampler), place);
    if (window.decoded == 1u && shown.a > 0.0) {
        shown.rgb = shown.a * srgb_decode(shown.rgb / shown.a);
    }
}

#version 460
// Exposure: each colour times a factor, one colour an invocation.

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Colours {
    vec4 values[];
} colours;

layout(std430, set = 0, binding = 1) buffer Exposed {
    vec4 values[];
} exposed;

layout(push_constant) uniform Settings {
    uint count;
    float factor; // 2^stops
} settings;

void main()
{
    uint at = gl_GlobalInvocationID.x;
    if (at >= settings.count) { return; }
    vec4 colour = colours.values[at];
    exposed.values[at] = vec4(settings.factor * colour.rgb, colour.a);
}

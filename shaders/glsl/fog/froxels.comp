#version 460
#extension GL_GOOGLE_include_directive : require
// A froxel volume (Wronski, "Volumetric Fog", 2014): light that was scattered before the end of each cell of the view,
// FILLed column by column, and read for each pixel. For `airglow report`.

layout(local_size_x = 64) in;

struct Row {
    vec4 extinction_extent;
    vec4 seen_along;
    vec4 off_weight;
};

struct Light {
    vec4 position; // relative to the eye, m; squared radius
    vec4 weight;
};

layout(std430, set = 0, binding = 0) readonly buffer Rows {
    Row values[];
} rows;

layout(std430, set = 0, binding = 1) buffer Airlight {
    vec4 values[];
} airlight;

layout(std430, set = 0, binding = 2) buffer Cells {
    vec4 values[];
} cells;

layout(std430, set = 0, binding = 3) readonly buffer Lights {
    Light values[];
} lights;

layout(push_constant) uniform Settings {
    vec4 corner;     // direction of the upper left; end of the first cell, m
    vec4 across;     // change to the right edge; logarithm of the last cell's end over the first's
    vec4 down;       // change to the lower edge; pixels along a side
    vec4 extinction; // 1/m
    uvec4 size;      // cells; lights
} settings;

#if FILL
void main()
{
    uvec3 size = settings.size.xyz;
    uint column = gl_GlobalInvocationID.x;
    if (column >= size.x * size.y) { return; }
    vec2 place = (vec2(column % size.x, column / size.x) + 0.5) / vec2(size.xy);
    vec3 direction = normalize(settings.corner.xyz + place.x * settings.across.xyz + place.y * settings.down.xyz);
    vec3 sum = vec3(0.0);
    float begin = 0.0;
    for (uint z = 0u; z < size.z; ++z) {
        float end = settings.corner.w * exp(settings.across.w * float(z) / float(size.z - 1u));
        float middle = 0.5 * (begin + end);
        vec3 point = middle * direction;
        vec3 arriving = vec3(0.0);
        for (uint i = 0u; i < settings.size.w; ++i) {
            vec3 towards = lights.values[i].position.xyz - point;
            float squared = dot(towards, towards) + lights.values[i].position.w;
            arriving += lights.values[i].weight.rgb * exp(-settings.extinction.rgb * sqrt(squared)) / squared;
        }
        sum += (end - begin) * arriving * exp(-settings.extinction.rgb * middle);
        cells.values[(z * size.y + column / size.x) * size.x + column % size.x] = vec4(sum, 1.0);
        begin = end;
    }
}
#else
vec3 slice(ivec3 cell)
{
    ivec3 size = ivec3(settings.size.xyz);
    // Nothing is scattered before the first cell.
    if (cell.z < 0) { return vec3(0.0); }
    ivec3 held = clamp(cell, ivec3(0), size - 1);
    return cells.values[(held.z * size.y + held.y) * size.x + held.x].rgb;
}

vec3 layer(ivec3 cell, vec2 part)
{
    vec3 upper = mix(slice(cell), slice(cell + ivec3(1, 0, 0)), part.x);
    vec3 lower = mix(slice(cell + ivec3(0, 1, 0)), slice(cell + ivec3(1, 1, 0)), part.x);
    return mix(upper, lower, part.y);
}

void main()
{
    uint side = uint(settings.down.w);
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= side * side) { return; }
    vec2 place = (vec2(pixel % side, pixel / side) + 0.5) / float(side) * vec2(settings.size.xy) - 0.5;
    float extent = rows.values[pixel].extinction_extent.w;
    float first = settings.corner.w;
    // Linear within the first cell, then by the logarithm.
    float z = extent < first ? extent / first - 1.0
        : min(log(extent / first) / settings.across.w, 1.0) * float(settings.size.z - 1u);
    vec3 at = floor(vec3(place, z));
    ivec3 cell = ivec3(at);
    vec3 part = vec3(place, z) - at;
    airlight.values[pixel] = vec4(mix(layer(cell, part.xy), layer(cell + ivec3(0, 0, 1), part.xy), part.z), 1.0);
}
#endif

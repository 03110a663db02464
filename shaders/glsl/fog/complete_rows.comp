#version 460
#extension GL_GOOGLE_include_directive : require
// The complete model, Sun 2008, eq. 3.29, on rows of parameters, by the functions that a host's forward shader calls at a
// vertex or a pixel: for tests.

#include "fog/airlight.glsl"

layout(local_size_x = 64) in;

// Everything is relative to the eye; the lamp sends 1 W/sr.
struct Row {
    vec4 lamp;            // m; w: k_d, 1/sr
    vec4 place;           // m; w: k_s, 1/sr
    vec4 normal_exponent; // unit vector; Phong's exponent
    vec4 extinction;      // 1/m; w: table of the diffuse lobe
    vec4 scattering;      // 1/m; w: table of the specular lobe
};

layout(std430, set = 0, binding = 0) readonly buffer Rows {
    Row values[];
} rows;

layout(std430, set = 0, binding = 1) readonly buffer Tables {
    float entries[];
} tables;

layout(std430, set = 0, binding = 2) buffer Radiance {
    float values[];
} radiance;

layout(push_constant) uniform Settings {
    uint count;
} settings;

#define FOG_LOBE_ENTRY(i) tables.entries[i]
#include "fog/surface.glsl"

void main()
{
    uint at = gl_GlobalInvocationID.x;
    if (at >= settings.count) { return; }
    Row row = rows.values[at];
    vec3 place = row.place.xyz;
    vec3 normal = row.normal_exponent.xyz;
    float distance = length(place);
    vec3 view = -place / distance;
    FogMedium medium = FogMedium(row.extinction.rgb, row.scattering.rgb, vec4(0.0), 0.0);
    FogIncident incident =
        fog_incident(medium.extinction, medium.scattering, vec3(1.0), vec3(1.0), row.lamp.xyz - place);
    vec3 reflected = row.lamp.w * fog_lambert(incident, normal, int(row.extinction.w))
        + row.place.w
            * fog_phong(incident, normal, reflect(-view, normal), int(row.scattering.w), row.normal_exponent.w);
    FogLight light = FogLight(vec4(row.lamp.xyz, 0.0), vec4(0.0), vec4(0.0, 0.0, 0.0, -2.0), vec4(0.0), vec4(0.0), vec4(0.0));
    light.intensity_reach.rgb = fog_seen(medium, vec3(1.0), light.position_radius);
    vec3 seen = fog_transmittance(medium, -view, distance) * reflected + fog_airlight(medium, light, 0, -view, distance);
    for (int channel = 0; channel < 3; ++channel) { radiance.values[3u * at + uint(channel)] = seen[channel]; }
}

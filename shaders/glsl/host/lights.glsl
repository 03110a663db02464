// The scene's point, spot and directional lights on a surface: a Lambertian lobe and GGX (Walter, Marschner, Li and
// Torrance 2007, in glTF's metallic-roughness form), attenuated by the medium on their way. No shadows.

struct Light {
    vec4 position_range; // m; w: where it ends, 0 for nowhere, -1: directional
    vec4 intensity_scale; // W/sr, or W/m2 of a directional one; w: scale of the cone's cosine
    vec4 axis_offset;     // the way the light travels; w: offset of the cone's cosine
};

layout(std140, set = 0, binding = 3) uniform Lights {
    vec4 extinction; // of the medium, 1/m; w unused
    vec4 scattering; // the same
    uvec4 count;     // x alone
    Light lights[64];
} lights;

const float LIGHTS_PI = 3.14159265358979;

// What arrives of a light per area across its way, W/m2; `towards` becomes the unit vector to it.
vec3 light_irradiance(Light light, vec3 position, out vec3 towards)
{
    if (light.position_range.w < 0.0) {
        towards = -light.axis_offset.xyz;
        return light.intensity_scale.rgb;
    }
    vec3 path = light.position_range.xyz - position;
    float squared = max(dot(path, path), 1e-6);
    float distance = sqrt(squared);
    towards = path / distance;
    float edge = clamp(light.intensity_scale.w * -dot(towards, light.axis_offset.xyz) + light.axis_offset.w, 0.0, 1.0);
    float share = light.position_range.w > 0.0 ? squared / (light.position_range.w * light.position_range.w) : 0.0;
    float end = clamp(1.0 - share * share, 0.0, 1.0);
    return light.intensity_scale.rgb * exp(-lights.extinction.rgb * distance) * (edge * edge * end / squared);
}

#if AIRGLOW_FOG
// What the medium about a place scatters there of a light; nothing of a directional one, and beyond a light's range. A spot
// shines into the medium as its light would, spread over the whole sphere.
FogIncident light_scattered(Light light, vec3 position)
{
    vec3 path = light.position_range.xyz - position;
    float reach = light.position_range.w;
    bool reaches = reach == 0.0 || (reach > 0.0 && dot(path, path) <= reach * reach);
    float scale = light.intensity_scale.w;
    float share = scale > 0.0 ? 0.5 * (1.0 + light.axis_offset.w / scale) : 1.0;
    vec3 scattered = reaches ? share * light.intensity_scale.rgb : vec3(0.0);
    return fog_incident(lights.extinction.rgb, lights.scattering.rgb, vec3(0.0), scattered, path);
}

// What a surface sends on of it to the eye; see `lights_reflected`.
vec3 glow_reflected(FogIncident incident, vec3 base, vec2 surface, float alpha, vec3 f0, vec3 n, vec3 v)
{
    if (incident.glow == vec3(0.0)) { return vec3(0.0); }
    vec3 fresnel = f0 + (1.0 - f0) * pow(clamp(1.0 - dot(n, v), 0.0, 1.0), 5.0);
    vec3 diffuse = (1.0 - fresnel) * (1.0 - surface.x) * base / LIGHTS_PI;
    vec3 glow = diffuse * fog_lobe_glow(incident, n, int(material.flags >> 8u & 0xffu), 1.0);
    int table = int(material.flags >> 16u);
    return glow + fresnel * fog_ggx_glow(incident, reflect(-v, n), table, fog_exponent_of_ggx(alpha));
}
#endif

// Radiance towards the eye; `surface` is metallic and roughness.
vec3 lights_reflected(vec3 base, vec2 surface, vec3 normal, vec3 position, vec3 eye)
{
    vec3 v = normalize(eye - position);
    vec3 n = normalize(normal);
    if (dot(n, v) < 0.0) { n = -n; }
    float alpha = max(surface.y * surface.y, 0.002);
    float alpha2 = alpha * alpha;
    vec3 f0 = mix(vec3(0.04), base, surface.x);
    float nv = max(dot(n, v), 1e-4);
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < lights.count.x; ++i) {
#if AIRGLOW_FOG
        sum += glow_reflected(light_scattered(lights.lights[i], position), base, surface, alpha, f0, n, v);
#endif
        vec3 l;
        vec3 irradiance = light_irradiance(lights.lights[i], position, l);
        float nl = dot(n, l);
        if (nl <= 0.0) { continue; }
        vec3 h = normalize(l + v);
        float nh = max(dot(n, h), 0.0);
        vec3 fresnel = f0 + (1.0 - f0) * pow(1.0 - max(dot(l, h), 0.0), 5.0);
        float denominator = nh * nh * (alpha2 - 1.0) + 1.0;
        float facets = alpha2 / (LIGHTS_PI * denominator * denominator);
        float masking = 0.5 / (nl * sqrt(nv * nv * (1.0 - alpha2) + alpha2) + nv * sqrt(nl * nl * (1.0 - alpha2) + alpha2));
        vec3 diffuse = (1.0 - fresnel) * (1.0 - surface.x) * base / LIGHTS_PI;
        sum += irradiance * nl * (diffuse + fresnel * facets * masking);
    }
    return sum;
}

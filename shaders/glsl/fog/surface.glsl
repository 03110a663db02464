// Light that a surface in fog reflects: what arrives straight from a lamp, and what the medium around it has scattered
// once. Sun, Ramamoorthi, Narasimhan and Nayar 2005; Sun 2008, section 3.4. Functions over values, no bindings: for a
// host's own forward shader, at each vertex or each pixel.
//
// The includer defines
//   FOG_LOBE_SIZE      entries along each side of a table, as the tables were built
//   FOG_LOBE_ENTRY(i)  entry i of the tables: a storage buffer of floats, or what the host made of it
//
// What a surface sends out is to be multiplied with what the way to the eye leaves of it, and the airlight of
// `airlight.glsl` added: Sun 2008, eq. 3.29.

#ifndef FOG_SURFACE_GLSL
#define FOG_SURFACE_GLSL

#include "fog/lobe.glsl"

// The light of one lamp at one place.
struct FogIncident {
    vec3 towards; // unit vector to the lamp
    vec3 direct;  // what arrives straight, per area across its way, W/m2
    vec3 glow;    // what G_n is to be multiplied with, W/m2
    vec3 optical; // optical distance of the lamp
    bool grey;    // the same for red, green and blue
};

// `path` leads from the surface to the lamp, m; `intensity` is what the lamp sends the surface, `scattered` what it sends
// into the medium, W/sr: the same but for a spot.
FogIncident fog_incident(vec3 extinction, vec3 scattering, vec3 intensity, vec3 scattered, vec3 path)
{
    float squared = max(dot(path, path), 1e-12);
    float distance = sqrt(squared);
    vec3 optical = extinction * distance;
    bool grey = extinction.r == extinction.g && extinction.g == extinction.b;
    vec3 direct = intensity * exp(-optical) / squared;
    return FogIncident(path / distance, direct, scattered * scattering * (0.159154943091895 / distance), optical, grey);
}

// The scattered light alone through the lobe cos^exponent about an axis, W/m2, by the lobe's table.
vec3 fog_lobe_glow(FogIncident incident, vec3 axis, int table, float exponent)
{
    float column = fog_lobe_column(length(axis - incident.towards), exponent);
    return incident.glow * fog_lobe_rgb(table, incident.optical, incident.grey, column);
}

// Irradiance of a surface, W/m2: times albedo over pi it is the radiance of a Lambertian one. Its table is of exponent 1.
vec3 fog_lambert(FogIncident incident, vec3 normal, int table)
{
    return incident.direct * max(dot(normal, incident.towards), 0.0) + fog_lobe_glow(incident, normal, table, 1.0);
}

// The same for Phong's lobe about the mirrored direction of the view: times k_s it is radiance.
vec3 fog_phong(FogIncident incident, vec3 normal, vec3 mirrored, int table, float exponent)
{
    vec3 glow = fog_lobe_glow(incident, mirrored, table, exponent);
    float cosine = dot(mirrored, incident.towards);
    if (dot(normal, incident.towards) <= 0.0 || cosine <= 0.0) { return glow; }
    return incident.direct * pow(cosine, exponent) + glow;
}

// The same for Blinn's lobe (n . h)^exponent. Its glow goes through Phong's lobe of a quarter of the exponent, to whose
// exponent the table belongs, at least 1: the same lobe for small angles in the plane of incidence.
vec3 fog_blinn(FogIncident incident, vec3 normal, vec3 view, int table, float exponent)
{
    vec3 glow = fog_lobe_glow(incident, reflect(-view, normal), table, max(0.25 * exponent, 1.0));
    vec3 between = incident.towards + view;
    float cosine = dot(normal, between) / max(length(between), 1e-20);
    if (dot(normal, incident.towards) <= 0.0 || cosine <= 0.0) { return glow; }
    return incident.direct * pow(cosine, exponent) + glow;
}

// `Lobe::Ggx(alpha).exponent()`, up to rounding.
float fog_exponent_of_ggx(float alpha)
{
    return clamp(0.4 * (1.0 / max(alpha * alpha, 1e-12) - 1.0), 0.05, 1000.0);
}

// The glow that a surface of GGX mirrors, W/sr/m2, to be multiplied with its Fresnel reflectance; the host's own BRDF
// reflects `incident.direct`. `exponent` and its table are those of `Lobe::Ggx`: no power has GGX's long tails, and this
// one's glow is within 30 % of it at any angle.
vec3 fog_ggx_glow(FogIncident incident, vec3 mirrored, int table, float exponent)
{
    return (0.159154943091895 * (exponent + 1.0)) * fog_lobe_glow(incident, mirrored, table, exponent);
}

#endif

// A surface with a normal map under light from all around: the incident radiance of its vertices, nine coefficients each, as
// the relight pass makes them with shadows in it.
//
// What of it a flat map would reflect diffusely is known better: the colour of the vertex. So of the sum over nine
// coefficients only the difference to a flat map counts, and a flat map has that colour itself.

#include "normals/harmonics.glsl"
#include "normals/environment.glsl"

layout(location = 5) in vec3 incident_0;
layout(location = 6) in vec3 incident_1;
layout(location = 7) in vec3 incident_2;
layout(location = 8) in vec3 incident_3;
layout(location = 9) in vec3 incident_4;
layout(location = 10) in vec3 incident_5;
layout(location = 11) in vec3 incident_6;
layout(location = 12) in vec3 incident_7;
layout(location = 13) in vec3 incident_8;

// What a surface reflects of it, about its tangent, bitangent and normal.
struct Gathered {
    NormalsMoments diffuse;  // of the normals
    NormalsMoments specular; // of the directions that are mirrored
    float grazing;           // share of the light that Fresnel's factor adds to that of the normal direction
};

Gathered gathered_none()
{
    NormalsMoments none = NormalsMoments(0.0, vec3(0.0), vec3(0.0), vec3(0.0));
    return Gathered(none, none, 0.0);
}

// Adds what a lobe of normals mirrors, by a share.
void gather_specular(inout Gathered sum, float share, NormalsLobe lobe, float alpha, vec3 view)
{
    normals_add_mirrored(sum.specular, sum.grazing, share, lobe, alpha, view);
}

// Adds one normal.
void gather_normal(inout Gathered sum, float share, vec3 normal, float alpha, vec3 view)
{
    normals_add_moments(sum.diffuse, vec3(share), normal);
    NormalsMirrored mirrored = normals_mirrored(normal, alpha, view);
    normals_add_moments(sum.specular, share * mirrored.bands, mirrored.direction);
    sum.grazing += share * mirrored.bands.x * mirrored.grazing;
}

// Radiance towards the eye; `flat_colour` is that of a white diffuse surface with a flat map.
vec3 gathered_radiance(Gathered sum, vec3 flat_colour, vec3 base, vec3 f0, vec3 diffuse, mat3 axes, bool matt)
{
    mat3 turn = axes;
    if ((material.flags & 2u) == 0u) {
        // The light is about the axes of the object.
        mat3 linear = mat3(material.world_from_object);
        turn = transpose(linear) * axes / length(linear[0]);
    }
    vec3 incident[9] = vec3[9](incident_0, incident_1, incident_2, incident_3, incident_4, incident_5, incident_6, incident_7, incident_8);
#define INCIDENT(i) incident[i]
    NormalsMoments normals = sum.diffuse;
    normals_add_moments(normals, vec3(-1.0), vec3(0.0, 0.0, 1.0));
    normals = normals_turned_moments(normals, turn);
    vec3 bands = vec3(0.0, NORMALS_COSINE_BANDS.yz);
    vec3 reflected = max(flat_colour + NORMALS_MOMENTS_SUM(normals, bands, INCIDENT), vec3(0.0));
    if (matt) { return base * reflected; }
    NormalsMoments mirrored = normals_turned_moments(sum.specular, turn);
    vec3 gloss = max(NORMALS_MOMENTS_SUM(mirrored, vec3(1.0), INCIDENT), vec3(0.0));
    float grazing = sum.grazing / max(sum.specular.weight, 1e-4);
    vec3 fresnel = f0 + (1.0 - f0) * grazing;
    return (1.0 - fresnel) * diffuse * reflected + fresnel * gloss;
}

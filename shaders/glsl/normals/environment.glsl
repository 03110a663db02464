// Gloss of lobes of normals under light from all around, given as nine coefficients: functions over values, no bindings.
//
// Walter, Marschner, Li and Torrance 2007. What a surface mirrors towards the view is told to three bands by its weight, a
// direction, and how much of each band it leaves.

#ifndef NORMALS_ENVIRONMENT_GLSL
#define NORMALS_ENVIRONMENT_GLSL

#include "normals/harmonics.glsl"

// What a lobe mirrors towards a view, but for Fresnel's factor.
struct NormalsMirrored {
    vec3 direction;
    vec3 bands;    // with normals_add_moments or NORMALS_HARMONIC_SUM about the direction
    float grazing; // (1 - v.h)^5 of Fresnel's factor by Schlick
};

NormalsMirrored normals_mirrored(NormalsLobe lobe, float alpha, vec3 view)
{
    NormalsGloss gloss = normals_gloss(lobe, 2.0 / (alpha * alpha), view);
    NormalsMirrored mirrored;
    mirrored.direction = gloss.direction;
    mirrored.bands = normals_gloss_bands(gloss);
    mirrored.grazing = pow(1.0 - clamp(dot(lobe.axis, view), 0.0, 1.0), 5.0);
    return mirrored;
}

#endif

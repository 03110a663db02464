// Airlight: what a ray's medium scatters towards the eye, once, out of the light of one point, spot or small sphere.
// Sun, Ramamoorthi, Narasimhan and Nayar 2005; Sun 2008, chapter 3. Functions over values, no bindings: for this
// room's passes and for a host's own shaders.
//
// The includer defines one of
//   PHASE_KIND_ISOTROPIC, PHASE_KIND_POLYNOMIAL, PHASE_KIND_HENYEY_GREENSTEIN, PHASE_KIND_DRAINE
// and FOG_TAPS, 6 or 16,
// and may define
//   FOG_HEIGHT                       1: the medium thins with height
//   FOG_POINTS                       1: no light has a cone, a range or a box
//   FOG_VISIBILITY(light, position)  what of a light arrives at a position relative to the eye, 0 to 1: the host's
//                                    shadow map; without it there is no such branch

#include "fog/light.glsl"
#include "fog/phase.glsl"
#include "fog/path.glsl"
#include "fog/interval.glsl"
#include "fog/taps.glsl"

// A homogeneous medium, or one that thins with height.
struct FogMedium {
    vec3 extinction; // 1/m; where it thins, at the height of the eye
    vec3 scattering; // 1/m, the same
    vec4 phase;      // polynomial: weights; Henyey-Greenstein: g; Draine: g, alpha
    float thinning;  // 1 over the height, m, in which it thins by e, along +Y
};

float fog_phase(vec4 values, vec2 halves)
{
#if defined(PHASE_KIND_POLYNOMIAL)
    return phase_polynomial(values, halves);
#elif defined(PHASE_KIND_HENYEY_GREENSTEIN)
    return phase_henyey_greenstein(values.x, halves);
#elif defined(PHASE_KIND_DRAINE)
    return phase_draine(values.x, values.y, halves);
#else
    return phase_isotropic();
#endif
}

// The path whose scale suits the phase function. Henyey and Greenstein's lobe over the distances of the paths is
// (off^2 + m^2)^(1/2) / ((1 - g)^2 off^2 + (1 + g)^2 m^2)^(3/2): its size is not off but off (1 - g) / (1 + g).
FogPath fog_suited(FogPath path, vec4 phase)
{
#if defined(PHASE_KIND_HENYEY_GREENSTEIN) || defined(PHASE_KIND_DRAINE)
    float ratio = (1.0 - phase.x) / (1.0 + phase.x);
    path.off_squared *= ratio * ratio;
#endif
    return path;
}

// The smallest extinction of a channel that scatters at all.
float fog_least(vec3 extinction)
{
    vec3 present = mix(extinction, vec3(1e30), equal(extinction, vec3(0.0)));
    return min(present.x, min(present.y, present.z));
}

// (exp(-x) - 1) / -x: the mean of what thins over x scale heights.
float fog_mean_density(float x)
{
    return abs(x) < 0.02 ? 1.0 - x * (0.5 - x * (1.0 / 6.0 - x / 24.0)) : (1.0 - exp(-x)) / x;
}

// How much of the surface's light is left after `distance`, which may be infinite.
vec3 fog_transmittance(FogMedium medium, vec3 direction, float distance)
{
#if FOG_HEIGHT
    return exp(-medium.extinction * distance * fog_mean_density(clamp(direction.y * distance * medium.thinning, -80.0, 1e30)));
#else
    return exp(-medium.extinction * distance);
#endif
}

// What FogLight holds of an intensity: times the light's scatter factor, and in a homogeneous medium what is left of it
// when it arrives at the eye. A host that knows it in f64 computes it there: in f32 the exponent of a long path is coarse.
vec3 fog_seen(FogMedium medium, vec3 intensity, vec4 position_radius)
{
#if FOG_HEIGHT
    return intensity;
#else
    return intensity * exp(-medium.extinction * length(position_radius));
#endif
}

// The part of the ray that a light can reach, empty where x >= y.
vec2 fog_interval(FogLight light, vec3 direction, float distance)
{
    vec2 interval = vec2(0.0, distance);
#if !FOG_POINTS
    vec3 position = light.position_radius.xyz;
    if (light.falloff_range.z > 0.0) {
        interval = fog_in_sphere(interval, position, light.falloff_range.z, direction);
    }
    if (light.axis_cosine.w > -1.5) {
        interval = fog_in_cone(interval, position, light.axis_cosine.xyz, light.axis_cosine.w, direction);
    }
    if (light.falloff_range.w > 0.5) { interval = fog_in_box(interval, light.low.xyz, light.high.xyz, direction); }
#endif
    return interval;
}

// What of the light's intensity goes towards a point at `distance` from it, `towards` the point: the cone's soft edge and
// the end of its range, as KHR_lights_punctual recommends them.
float fog_falloff(FogLight light, vec3 towards, float distance)
{
    float factor = 1.0;
#if !FOG_POINTS
    if (light.axis_cosine.w > -1.5) {
        float cosine = dot(light.axis_cosine.xyz, towards) / max(distance, 1e-30);
        float edge = clamp(cosine * light.falloff_range.x + light.falloff_range.y, 0.0, 1.0);
        factor = edge * edge;
    }
    if (light.falloff_range.z > 0.0) {
        float share = distance / light.falloff_range.z;
        factor *= clamp(1.0 - share * share * share * share, 0.0, 1.0);
    }
#endif
    return factor;
}

// Where the part that begins at `begin` ends: a spot's intensity has a kink at either end of its plateau.
float fog_part_end(vec2 plateau, float begin, float end)
{
    return begin < plateau.x ? plateau.x : begin < plateau.y ? plateau.y : end;
}

// The plateau of a spot's intensity in the part of the ray that it reaches; the beginning twice where there is none.
vec2 fog_plateau(FogLight light, vec3 direction, vec2 interval)
{
#if !FOG_POINTS
    float cosine = (1.0 - light.falloff_range.y) / light.falloff_range.x;
    if (light.axis_cosine.w > -1.5 && cosine < 1.0) {
        vec3 position = light.position_radius.xyz;
        vec2 plateau = fog_in_cone(interval, position, light.axis_cosine.xyz, cosine, direction);
        if (plateau.x < plateau.y) { return plateau; }
    }
#endif
    return interval.xx;
}

// The integral over a part of the ray, without what all parts share: scattering coefficient and intensity.
vec3 fog_part(FogMedium medium, FogLight light, int index, vec3 direction, FogPath path, vec2 interval)
{
    vec3 position = light.position_radius.xyz;
    FogSegment segment = fog_segment(path, interval.x, interval.y - interval.x);
    FogTaps taps = fog_taps(fog_suited(path, medium.phase), segment, fog_least(medium.extinction));
    vec3 sum = vec3(0.0);
    for (int i = 0; i < FOG_TAPS; ++i) {
        FogTap tap = fog_tap(taps, path, segment, i);
        float m = segment.start + tap.excess;
        float at = fog_distance(path, m);
        vec3 point = at * direction;
        float to_light = 0.5 * (m + path.off_squared / m);
        float weight = tap.weight * fog_falloff(light, point - position, to_light);
        weight *= fog_phase(medium.phase, vec2(path.off_squared, m * m) * tap.density);
#ifdef FOG_VISIBILITY
        weight *= FOG_VISIBILITY(index, point);
#endif
#if FOG_HEIGHT
        // Optical length of both legs, and the density where they meet.
        float rise = point.y * medium.thinning;
        float density = exp(-rise);
        float legs = at * fog_mean_density(rise)
            + to_light * density * fog_mean_density((position.y - point.y) * medium.thinning);
        sum += weight * density * exp(-medium.extinction * legs);
#else
        sum += weight * exp(-medium.extinction * (segment.before + light.high.w + tap.excess));
#endif
    }
    return sum;
}

// The airlight of one light along a ray of unit direction up to a surface at `distance`, which may be infinite
// (above 1e30), W/sr/m2. `index` is what FOG_VISIBILITY gets.
vec3 fog_airlight(FogMedium medium, FogLight light, int index, vec3 direction, float distance)
{
    vec2 interval = fog_interval(light, direction, distance);
    if (interval.x >= interval.y) { return vec3(0.0); }
    FogPath path = fog_path(light.position_radius.xyz, direction, light.position_radius.w);
    vec2 plateau = fog_plateau(light, direction, interval);
    vec3 sum = vec3(0.0);
    float begin = interval.x;
    do {
        float end = fog_part_end(plateau, begin, interval.y);
        // Always so by the loop's own condition, but llvmpipe (Mesa 22.3) lets a lane go on while its neighbours do.
        if (begin < end) { sum += fog_part(medium, light, index, direction, path, vec2(begin, end)); }
        begin = end;
    } while (begin < interval.y);
    return medium.scattering * light.intensity_reach.rgb * sum;
}

// What every rival gets: one light and one ray, and the integral of exp(-extinction (x + d)) / d^2 over it, 1/m.
//
// CHANNELS is 1, a grey medium, or 3.

#if CHANNELS == 3
#define COLOUR vec3
#else
#define COLOUR float
#endif

struct Configuration {
    COLOUR extinction; // 1/m, above 0
    COLOUR seen;       // exp(-extinction times the light's distance), which a host knows in f64 for each light
    float along;       // distance along the ray of the light's foot, m
    float off;         // distance of the light from the ray, m
    float extent;      // length of the ray, m; above 1e30 without end
};

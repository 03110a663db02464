// Marching: the midpoint rule along the ray, in equal steps or, EQUIANGULAR, in equal angles at the light (Kulla and
// Fajardo 2012). Both end where the path's excess has cost exp(-20).

COLOUR rival_airlight(Configuration c, int steps)
{
    float distance = sqrt(c.along * c.along + c.off * c.off);
    // The path over x is longer than the light's distance by cut where x = cut (distance + cut / 2) / (distance + cut - along).
#if CHANNELS == 3
    float cut = 20.0 / min(c.extinction.r, min(c.extinction.g, c.extinction.b));
#else
    float cut = 20.0 / c.extinction;
#endif
    float extent = min(c.extent, cut * (distance + 0.5 * cut) / (distance + cut - c.along));
    COLOUR sum = COLOUR(0.0);
#if EQUIANGULAR
    float first = atan(-c.along, c.off);
    float step_angle = (atan(extent - c.along, c.off) - first) / float(steps);
    for (int i = 0; i < steps; ++i) {
        float angle = first + (float(i) + 0.5) * step_angle;
        float cosine = cos(angle);
        sum += exp(-c.extinction * (c.along + c.off * (1.0 + sin(angle)) / cosine));
    }
    return sum * step_angle / c.off;
#else
    float step_length = extent / float(steps);
    for (int i = 0; i < steps; ++i) {
        float x = (float(i) + 0.5) * step_length;
        float delta = x - c.along;
        float squared = c.off * c.off + delta * delta;
        sum += exp(-c.extinction * (x + sqrt(squared))) / squared;
    }
    return sum * step_length;
#endif
}

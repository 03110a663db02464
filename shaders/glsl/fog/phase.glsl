// Phase functions, 1/sr: the share of scattered light that leaves at an angle a from the way it came, 0 straight on.
// `halves` are cos^2(a / 2) and sin^2(a / 2), of sum 1: the peaks of lobes are at 0 of one of them, where the cosine of a
// has lost them to rounding. All but the polynomial integrate to 1 over the sphere.

const float PHASE_ISOTROPIC = 0.0795774715459477; // 1 / (4 pi)

float phase_isotropic()
{
    return PHASE_ISOTROPIC;
}

// Powers of the cosine (Sun 2008, eq. 3.18). The weights hold the 1 / (4 pi).
float phase_polynomial(vec4 weights, vec2 halves)
{
    float cosine = halves.x - halves.y;
    return weights.x + cosine * (weights.y + cosine * (weights.z + cosine * weights.w));
}

// Henyey and Greenstein 1941; g is the mean cosine, between -1 and 1.
float phase_henyey_greenstein(float g, vec2 halves)
{
    // 1 + g^2 - 2 g cosine, as a sum of positive terms.
    float squared = (1.0 - g) * (1.0 - g) * halves.x + (1.0 + g) * (1.0 + g) * halves.y;
    return PHASE_ISOTROPIC * (1.0 - g * g) / (squared * sqrt(squared));
}

// Draine 2003, eq. 4: Henyey and Greenstein at alpha 0, Rayleigh at g 0 and alpha 1.
float phase_draine(float g, float alpha, vec2 halves)
{
    float cosine = halves.x - halves.y;
    float shape = (1.0 + alpha * cosine * cosine) / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
    return shape * phase_henyey_greenstein(g, halves);
}

// The rival: the product of the visibilities of spheres, one after the other. Included by shadow/blockers.glsl.

// Band factors of the visibility of a cap less 1 (Sun 2008, equation 5.36).
void visibility_factors(float square, float scale, out float bands[ORDER])
{
    const float TWO_PI = 6.28318530717959;
    float c = sqrt(1.0 - square);
    float c2 = c * c;
    scale *= -TWO_PI;
    bands[0] = scale / (1.0 + c);
    bands[1] = scale * 0.5;
    bands[2] = scale * (0.5 * c);
#if ORDER > 3
    bands[3] = scale * (0.625 * c2 - 0.125);
#endif
#if ORDER > 4
    bands[4] = scale * (c * (0.875 * c2 - 0.375));
#endif
#if ORDER > 5
    bands[5] = scale * (c2 * (1.3125 * c2 - 0.875) + 0.0625);
#endif
}

// Over the coefficients i of a band, with bounds that a compiler sees.
#define BAND(l, begin, end, statement) for (int i = begin; i < end; ++i) { statement(i, l) }
#if ORDER > 3
#define BAND3(statement) BAND(3, 9, 16, statement)
#else
#define BAND3(statement)
#endif
#if ORDER > 4
#define BAND4(statement) BAND(4, 16, 25, statement)
#else
#define BAND4(statement)
#endif
#if ORDER > 5
#define BAND5(statement) BAND(5, 25, 36, statement)
#else
#define BAND5(statement)
#endif
#define EACH_BAND(statement)                                                                                            \
    BAND(0, 0, 1, statement) BAND(1, 1, 4, statement) BAND(2, 4, 9, statement) BAND3(statement) BAND4(statement)        \
    BAND5(statement)

// What a sphere leaves a receiver to see.
void visibility_of(vec4 sphere, float share, Receiver receiver, out float term[COUNT])
{
    vec4 cap = shadow_cap(sphere.xyz, sphere.w, receiver.place);
    float bands[ORDER];
    visibility_factors(cap.w, share * cap.w, bands);
    sh_evaluate(cap.xyz, term);
#define SCALED(i, l) term[i] *= bands[l];
    EACH_BAND(SCALED)
    term[0] += ONE;
}

// The product of the visibilities of all chosen nodes; how many there are.
uint accumulate(Receiver receivers[RECEIVERS], out float sums[RECEIVERS][COUNT])
{
    uint here = 0u;
    EACH(i) { sums[0][i] = i == 0 ? ONE : 0.0; }
    uint word = 0u;
    do {
        uint bits = chosen[SMALL][word];
        here += uint(bitCount(bits));
        do {
            bool there = bits != 0u;
            uint at = 32u * word + (uint(findLSB(bits)) & 31u);
            float term[COUNT];
            visibility_of(spheres.values[at], there ? nodes.values[at].x : 0.0, receivers[0], term);
            bits &= bits - 1u;
            float product[COUNT];
            sh_product(sums[0], term, product);
            sums[0] = product;
        } while (bits != 0u);
        ++word;
    } while (word < words[SMALL]);
    return here;
}

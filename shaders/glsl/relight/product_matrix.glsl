// The product matrix of a uniform light (Sun 2008, eq. 5.10), symmetric: its lower triangle by rows, RGB.

layout(std140, set = 0, binding = 4) uniform ProductMatrix {
    vec4 lower[COEFFICIENTS * (COEFFICIENTS + 1) / 2];
} product_matrix;

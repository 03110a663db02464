// What host.cpp lights: a dome and a ring on a plain, a sky with a low sun, and the picture of it.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

// A height field over [-1, 1)^2 in x and z, side * side vertices row by row. The right-hand rule of its triangles and
// its normals point up.
struct Field {
    std::vector<float> positions, normals;
    std::vector<uint32_t> indices;

    explicit Field(uint32_t side) {
        const float step = 2.f / side;
        for (uint32_t i = 0; i < side * side; i++) {
            const float x = (i % side) * step - 1, z = (i / side) * step - 1;
            positions.insert(positions.end(), {x, height(x, z), z});
            normals.insert(normals.end(), {height(x - step, z) - height(x + step, z), 2 * step,
                                           height(x, z - step) - height(x, z + step)});
            if (i % side + 1 < side && i / side + 1 < side)
                indices.insert(indices.end(), {i, i + side, i + 1, i + 1, i + side, i + side + 1});
        }
    }

    static float height(float x, float z) {
        const float dome = 0.16f - std::pow(std::hypot(x + 0.3f, z - 0.3f), 2.f);
        const float ring = 0.01f - std::pow(std::hypot(x - 0.35f, z + 0.35f) - 0.35f, 2.f);
        return std::sqrt(std::max({0.f, dome, 4 * ring}));
    }
};

// An equirectangular sky of linear radiance: blue above, grey below, and a warm sun 35 degrees over the -X horizon,
// which is at a quarter of the width.
inline std::vector<float> sky(int width, int height) {
    std::vector<float> texels;
    for (int i = 0; i < width * height; i++) {
        const float u = (i % width + 0.5f) / width, v = (i / width + 0.5f) / height;
        const bool sun = std::hypot(2 * (u - 0.25f), v - 0.31f) < 0.04f;
        if (sun) texels.insert(texels.end(), {60.f, 45.f, 25.f});
        else if (v < 0.5f) texels.insert(texels.end(), {0.2f, 0.3f, 0.6f});
        else texels.insert(texels.end(), {0.2f, 0.2f, 0.2f});
    }
    return texels;
}

// The colours of the vertices as a picture seen from above, one pixel a vertex: a PPM file in sRGB.
inline bool write_picture(const char *path, uint32_t side, const float *colours) {
    std::FILE *file = std::fopen(path, "wb");
    if (!file) return false;
    std::fprintf(file, "P6 %u %u 255\n", side, side);
    for (uint32_t i = 0; i < side * side * 4; i++) {
        if (i % 4 == 3) continue;  // the fourth value of a colour is 1
        const float linear = std::clamp(colours[i], 0.f, 1.f);
        const float srgb = linear < 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
        std::fputc(static_cast<int>(255 * srgb + 0.5f), file);
    }
    return std::fclose(file) == 0;
}

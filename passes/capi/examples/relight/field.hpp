// What host.cpp lights: a dome and a ring on a plain, and a sky with a low sun.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
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

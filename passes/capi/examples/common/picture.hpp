// A picture of linear colours as a file.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

// Rows of four floats a pixel, the fourth unused: a PPM file in sRGB.
inline bool write_picture(const char *path, uint32_t width, uint32_t height, const float *colours) {
    std::FILE *file = std::fopen(path, "wb");
    if (!file) return false;
    std::fprintf(file, "P6 %u %u 255\n", width, height);
    for (uint32_t i = 0; i < width * height * 4; i++) {
        if (i % 4 == 3) continue;
        const float linear = std::clamp(colours[i], 0.f, 1.f);
        const float srgb = linear < 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
        std::fputc(static_cast<int>(255 * srgb + 0.5f), file);
    }
    return std::fclose(file) == 0;
}

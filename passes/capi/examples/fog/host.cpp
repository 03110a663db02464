// A host in C++: draws fog with two lamps over a plain of its own, on a Vulkan device of its own, in a command buffer of
// its own, and writes a picture: fog.ppm, or where its argument says.
#include "image.hpp"
#include "picture.hpp"

static const uint32_t width = 192, height = 108;
static const double edges[4] = {-0.8, 0.8, -0.45, 0.45}, eye_height = 1.7, near_plane = 0.1;

// What a renderer would have drawn: a plain in squares below a black sky, and its depth, reversed and infinite.
static void draw(float *surface, float *depth) {
    for (uint32_t i = 0; i < width * height; i++) {
        const double x = edges[0] + (i % width + 0.5) / width * (edges[1] - edges[0]);
        const double y = edges[3] + (i / width + 0.5) / height * (edges[2] - edges[3]);
        const double distance = y < 0 ? -eye_height / y : INFINITY;  // along the axis of the view
        const bool pale = y < 0 && ((int)std::floor(x * distance / 2) + (int)std::floor(distance / 2)) % 2 == 0;
        for (int channel = 0; channel < 4; channel++) surface[4 * i + channel] = y < 0 ? (pale ? 0.10f : 0.03f) : 0.f;
        depth[i] = (float)(near_plane / distance);
    }
}

int main(int count, char **arguments) {
    AirglowFogSettings settings = {};  // zero is the default of every field
    settings.struct_size = sizeof settings;
    AirglowRequirements *requirements;
    check(airglow_requirements_new(&requirements, &error));
    check(airglow_fog_require(requirements, &settings, &error));
    const Device host(requirements);
    AirglowAdoptInfo adopt = host.adopt();
    adopt.requirements = requirements;
    AirglowContext *context;
    AirglowFog *fog;
    check(airglow_context_adopt(&adopt, &context, &error));
    check(airglow_fog_new(context, &settings, &fog, &error));

    // A view through a medium, its lamps, and how the host stores depth.
    AirglowWorld world = {};
    world.struct_size = sizeof world, world.depth_reversed = 1, world.depth_near = near_plane;
    world.depth_far = INFINITY;
    AirglowFogLight lamps[2] = {};
    lamps[0].position[0] = -3, lamps[0].position[1] = 3, lamps[0].position[2] = -12, lamps[0].radius = 0.2;
    lamps[0].intensity[0] = 60, lamps[0].intensity[1] = 40, lamps[0].intensity[2] = 15;
    lamps[1].position[0] = 4, lamps[1].position[1] = 5, lamps[1].position[2] = -16, lamps[1].radius = 0.2;
    lamps[1].intensity[0] = 60, lamps[1].intensity[1] = 80, lamps[1].intensity[2] = 100;
    lamps[1].cone_direction[1] = -1, lamps[1].cone_inner = 0.3, lamps[1].cone_outer = 0.5;
    AirglowFogView view = {};
    view.struct_size = sizeof view, view.world = &world, view.lights = lamps, view.light_count = 2;
    view.eye[1] = eye_height, view.right[0] = 1, view.up[1] = 1, view.forward[2] = -1, view.phase[0] = 0.3;
    for (int i = 0; i < 4; i++) view.edges[i] = edges[i];
    for (int i = 0; i < 3; i++) view.extinction[i] = 0.06, view.albedo[i] = 0.9;
    AirglowPrepared *prepared;
    check(airglow_fog_prepare(fog, width, height, &view, &prepared, &error));
    {
        const VkFormat hdr = VK_FORMAT_R32G32B32A32_SFLOAT;
        const VkImageUsageFlags read = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        const VkImageUsageFlags drawn = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        const VkExtent2D extent = {width, height};
        const Image surface(host.device, hdr, extent, read, VK_IMAGE_ASPECT_COLOR_BIT);
        const VkImageUsageFlags tested = read | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
        const Image depth(host.device, VK_FORMAT_D32_SFLOAT, extent, tested, VK_IMAGE_ASPECT_DEPTH_BIT);
        const Image target(host.device, hdr, extent, drawn, VK_IMAGE_ASPECT_COLOR_BIT);
        const AirglowBinding bindings[3] = {surface.binding(AIRGLOW_FOG_RESOURCE_SURFACE),
                                            depth.binding(AIRGLOW_FOG_RESOURCE_DEPTH),
                                            target.binding(AIRGLOW_FOG_RESOURCE_TARGET)};
        AirglowAccess uses[3];  // one for each resource, in their order
        size_t use_count = 3;
        check(airglow_prepared_accesses(prepared, uses, &use_count, &error));
        const Readable texels(host.physical, host.device, 16 * width * height, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
        const Readable depths(host.physical, host.device, 4 * width * height, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
        const Readable picture(host.physical, host.device, 16 * width * height, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        draw(static_cast<float *>(texels.data), static_cast<float *>(depths.data));
        submit(host.device, 0, [&](VkCommandBuffer commands) {
            surface.bring(commands, uses[AIRGLOW_FOG_RESOURCE_SURFACE], &texels);
            depth.bring(commands, uses[AIRGLOW_FOG_RESOURCE_DEPTH], &depths);
            target.bring(commands, uses[AIRGLOW_FOG_RESOURCE_TARGET], nullptr);
            check(airglow_prepared_record(prepared, integer(commands), bindings, 3, &error));
            target.read(commands, uses[AIRGLOW_FOG_RESOURCE_TARGET], picture);
        });
        const char *path = count > 1 ? arguments[1] : "fog.ppm";
        if (!write_picture(path, width, height, static_cast<float *>(picture.data))) return std::perror(path), 1;
        check(airglow_prepared_forget(prepared, &error));
    }
    airglow_prepared_drop(prepared), airglow_fog_drop(fog), airglow_context_drop(context);
    airglow_requirements_drop(requirements);
    return 0;
}

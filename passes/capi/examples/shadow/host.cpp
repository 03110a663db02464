// A host in C++: a ball hovers over a field, and what it leaves each vertex to see goes from the shadow pass to relighting,
// in the host's own command buffer. Writes a picture: shadowed.ppm, or where its argument says.
#include "../relight/field.hpp"
#include "device.hpp"
#include "picture.hpp"
#include <cstring>

static const uint32_t side = 128, vertices = side * side, order = 3, storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

struct Buffer : Readable {
    VkDeviceSize size;
    Buffer(const Device &host, VkDeviceSize size, const std::vector<float> &contents = {})
        : Readable(host.physical, host.device, size, storage), size(size) {
        std::memcpy(data, contents.data(), 4 * contents.size());
    }
    AirglowBinding binding(uint32_t resource) const {
        AirglowBinding binding = {};
        binding.resource = resource, binding.buffer = integer(buffer), binding.size = size, binding.usage = storage;
        return binding;
    }
};

// How a frame uses a resource that it uses once.
static AirglowAccess use(const AirglowPrepared *prepared, uint32_t resource) {
    AirglowAccess uses[32], found = {};
    size_t count = 32;
    check(airglow_prepared_accesses(prepared, uses, &count, &error));
    for (size_t i = 0; i < count; i++)
        if (uses[i].resource == resource) found = uses[i];
    return found;
}

static void barrier(VkCommandBuffer commands, const AirglowAccess &from, uint64_t stage, uint64_t access) {
    VkMemoryBarrier2 barrier = {VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, from.stage, from.access, stage, access};
    VkDependencyInfo dependency = {VK_STRUCTURE_TYPE_DEPENDENCY_INFO, nullptr, 0, 1, &barrier, 0, 0, 0, 0};
    vkCmdPipelineBarrier2(commands, &dependency);
}

int main(int count, char **arguments) {
    AirglowRelightSettings settings = {};  // zero is the default of every field
    settings.struct_size = sizeof settings, settings.order = order, settings.visibility = 1, settings.normals = 1;
    AirglowShadowSettings shadow_settings = {};
    shadow_settings.struct_size = sizeof shadow_settings, shadow_settings.order = order, shadow_settings.normals = 1;
    AirglowRequirements *requirements;
    check(airglow_requirements_new(&requirements, &error));
    check(airglow_relight_require(requirements, &settings, &error));
    check(airglow_shadow_require(requirements, &shadow_settings, &error));
    const Device host(requirements);
    AirglowAdoptInfo adopt = host.adopt();
    adopt.requirements = requirements;
    AirglowContext *context;
    AirglowRelight *relight;
    AirglowShadow *shadow;
    check(airglow_context_adopt(&adopt, &context, &error));
    check(airglow_relight_new(context, &settings, &relight, &error));
    check(airglow_shadow_new(context, &shadow_settings, &shadow, &error));

    // The field, the sky, and the ball.
    const Field field(side);
    AirglowRelightInstance instance = {};
    instance.inputs = AIRGLOW_INPUT_VISIBILITY | AIRGLOW_INPUT_NORMALS;
    check(airglow_relight_add_mesh(relight, "field", vertices, nullptr, 0, &instance.mesh, &error));
    check(airglow_relight_set_environment(relight, 128, 64, sky(128, 64).data(), &error));
    AirglowRelightFrame frame = {};
    frame.struct_size = sizeof frame, frame.light = AIRGLOW_LIGHT_ENVIRONMENT;
    frame.instances = &instance, frame.instance_count = 1;
    AirglowPrepared *relit, *shadowed;
    check(airglow_relight_prepare(relight, &frame, &relit, &error));
    check(airglow_prepared_make_scratch(relit, &error));
    AirglowShadowReceivers *receivers;
    check(airglow_shadow_receivers_new(shadow, "field", field.positions.data(), vertices, &receivers, &error));
    check(airglow_shadow_prepare(shadow, receivers, &shadowed, &error));
    const AirglowSphere ball = {{0.5, 0.3, 0.5}, 0.2};
    check(airglow_shadow_set(shadowed, &ball, 1, nullptr, nullptr, &error));
    {
        const Buffer positions(host, 12 * vertices, field.positions), normals(host, 12 * vertices, field.normals);
        const Buffer visibility(host, 4 * order * order * vertices), records(host, vertices / 64 * 8);
        const Buffer colours(host, 16 * vertices);
        const AirglowBinding blocked[4] = {
            positions.binding(AIRGLOW_SHADOW_RESOURCE_POSITIONS), normals.binding(AIRGLOW_SHADOW_RESOURCE_NORMALS),
            visibility.binding(AIRGLOW_SHADOW_RESOURCE_VISIBILITY), records.binding(AIRGLOW_SHADOW_RESOURCE_RECORDS)};
        const AirglowBinding lit[3] = {visibility.binding(AIRGLOW_RELIGHT_RESOURCE_VISIBILITY),
                                       normals.binding(AIRGLOW_RELIGHT_RESOURCE_NORMALS),
                                       colours.binding(AIRGLOW_RELIGHT_RESOURCE_RESULTS)};
        const AirglowAccess seen = use(relit, AIRGLOW_RELIGHT_RESOURCE_VISIBILITY);
        submit(host.device, 0, [&](VkCommandBuffer commands) {
            check(airglow_prepared_record(shadowed, integer(commands), blocked, 4, &error));
            barrier(commands, use(shadowed, AIRGLOW_SHADOW_RESOURCE_VISIBILITY), seen.stage, seen.access);
            check(airglow_prepared_record(relit, integer(commands), lit, 3, &error));
            const AirglowAccess made = use(relit, AIRGLOW_RELIGHT_RESOURCE_RESULTS);
            barrier(commands, made, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
        });
        const char *path = count > 1 ? arguments[1] : "shadowed.ppm";
        if (!write_picture(path, side, side, (float *)colours.data)) return std::perror(path), 1;
    }
    airglow_prepared_drop(shadowed), airglow_prepared_drop(relit), airglow_shadow_receivers_drop(receivers);
    airglow_shadow_drop(shadow), airglow_relight_drop(relight), airglow_context_drop(context);
    return airglow_requirements_drop(requirements), 0;
}

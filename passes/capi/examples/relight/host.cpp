// A host in C++: relights a mesh of its own on a Vulkan device of its own, in a command buffer of its own, and writes
// the vertex colours as a picture: relit.ppm, or where its argument says.
#include <vulkan/vulkan.h>
#include "airglow.h"
#include "field.hpp"
#include "picture.hpp"
#include "readable.hpp"

static AirglowError error = {sizeof error, AIRGLOW_STATUS_OK, 0, 0, {}};
static void check(AirglowStatus status) {
    if (status != AIRGLOW_STATUS_OK) std::fprintf(stderr, "airglow: %s\n", error.message), std::exit(1);
}
template <class T> static uint64_t integer(T handle) { return (uint64_t)handle; }

int main(int count, char **arguments) {
    // What the pass asks of a device; then an instance, and a device that has it.
    AirglowRelightSettings settings = {};  // zero is the default of every field
    settings.struct_size = sizeof settings, settings.order = 6;
    AirglowRequirements *requirements;
    check(airglow_requirements_new(&requirements, &error));
    check(airglow_relight_require(requirements, &settings, &error));
    VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO, 0, "host", 0, 0, 0, VK_API_VERSION_1_3};
    VkInstanceCreateInfo instance_info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, 0, 0, &application, 0, 0, 0, 0};
    VkInstance instance;
    check(vkCreateInstance(&instance_info, nullptr, &instance));
    VkPhysicalDevice physical = nullptr;  // the first one; check says what it lacks
    uint32_t one = 1;
    check(vkEnumeratePhysicalDevices(instance, &one, &physical));
    AirglowPhysicalDevice candidate = {sizeof candidate, 0, (AirglowFunction)vkGetInstanceProcAddr, integer(instance),
                                       integer(physical)};
    check(airglow_requirements_check(requirements, &candidate, nullptr, &error));
    const float priority = 1;
    VkDeviceQueueCreateInfo queue_info = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, 0, 0, 0, 1, &priority};
    VkDeviceCreateInfo device_info = {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, 0, 0, 1, &queue_info, 0, 0, 0, 0, 0};
    check(airglow_requirements_patch(requirements, &candidate, VK_API_VERSION_1_3, (void **)&device_info.pNext, nullptr,
                                     &error));
    VkDevice device;
    check(vkCreateDevice(physical, &device_info, nullptr, &device));

    // airglow on that device, a mesh baked on four threads, and light.
    AirglowAdoptInfo adopt = {};
    adopt.struct_size = sizeof adopt, adopt.api_version = VK_API_VERSION_1_3, adopt.requirements = requirements;
    adopt.get_instance_proc_addr = candidate.get_instance_proc_addr, adopt.instance = integer(instance);
    adopt.physical_device = integer(physical), adopt.device = integer(device), adopt.frames_in_flight = 1;
    adopt.device_create_info = &device_info;
    AirglowContext *context;
    AirglowRelight *relight;
    check(airglow_context_adopt(&adopt, &context, &error));
    check(airglow_relight_new(context, &settings, &relight, &error));
    const uint32_t side = 128, vertices = side * side;
    const Field field(side);
    std::vector<float> transfer(vertices * settings.order * settings.order);
    AirglowBakeInfo bake = {};
    bake.struct_size = sizeof bake, bake.order = settings.order, bake.rays = 128, bake.threads = 4;
    bake.positions = field.positions.data(), bake.normals = field.normals.data(), bake.vertex_count = vertices;
    bake.indices = field.indices.data(), bake.index_count = field.indices.size();
    check(airglow_bake(&bake, transfer.data(), transfer.size(), nullptr, &error));
    AirglowRelightInstance instances[1] = {};
    check(airglow_relight_add_mesh(relight, "field", vertices, transfer.data(), transfer.size(), &instances[0].mesh,
                                   &error));
    check(airglow_relight_set_environment(relight, 128, 64, sky(128, 64).data(), &error));

    // A frame, and the host's buffer for its results.
    AirglowRelightFrame frame = {};
    frame.struct_size = sizeof frame, frame.light = AIRGLOW_LIGHT_ENVIRONMENT;
    frame.instances = instances, frame.instance_count = 1;
    AirglowPrepared *prepared;
    check(airglow_relight_prepare(relight, &frame, &prepared, &error));
    check(airglow_prepared_make_scratch(prepared, &error));
    AirglowRelightBytes bytes;
    check(airglow_relight_bytes(&settings, vertices, &bytes, &error));
    {
        const uint32_t usage = bytes.results_usage | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;
        Readable colours(physical, device, bytes.results, usage);
        AirglowBinding binding = {};
        binding.resource = AIRGLOW_RELIGHT_RESOURCE_RESULTS, binding.buffer = integer(colours.buffer);
        binding.size = bytes.results, binding.usage = usage;
        AirglowAccess uses[32], results = {};  // the use to wait for; the first of each is waited for by the submission
        size_t use_count = 32;
        check(airglow_prepared_accesses(prepared, uses, &use_count, &error));
        for (size_t i = 0; i < use_count; i++)
            if (uses[i].resource == AIRGLOW_RELIGHT_RESOURCE_RESULTS) results = uses[i];
        submit(device, 0, [&](VkCommandBuffer commands) {
            check(airglow_prepared_record(prepared, integer(commands), &binding, 1, &error));
            VkMemoryBarrier2 barrier = {VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, results.stage, results.access,
                                        VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};
            VkDependencyInfo dependency = {VK_STRUCTURE_TYPE_DEPENDENCY_INFO, nullptr, 0, 1, &barrier, 0, 0, 0, 0};
            vkCmdPipelineBarrier2(commands, &dependency);
        });
        const char *path = count > 1 ? arguments[1] : "relit.ppm";
        if (!write_picture(path, side, side, static_cast<float *>(colours.data))) return std::perror(path), 1;
    }
    airglow_prepared_drop(prepared), airglow_relight_drop(relight), airglow_context_drop(context);
    airglow_requirements_drop(requirements);
    vkDestroyDevice(device, nullptr), vkDestroyInstance(instance, nullptr);
    return 0;
}

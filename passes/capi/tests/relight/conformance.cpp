// A host in C++ that makes its own device and has the conformance kit check the library on it.
#include <vulkan/vulkan.h>
#define AIRGLOW_CONFORMANCE
#include "airglow.h"
#include <cstdio>
#include <cstdlib>

static AirglowError error = {sizeof error, AIRGLOW_STATUS_OK, 0, 0, {}};
static void check(AirglowStatus status) {
    if (status != AIRGLOW_STATUS_OK) std::fprintf(stderr, "airglow: %s\n", error.message), std::exit(1);
}
static void check(VkResult result) {
    if (result < 0) std::fprintf(stderr, "Vulkan returned %d\n", result), std::exit(1);
}
template <class T> static uint64_t integer(T handle) { return (uint64_t)handle; }

static void report(void *user, const char *name, const char *failure) {
    std::printf("%s: %s\n", name, failure ? failure : "passed");
    ++*static_cast<int *>(user);
}

int main() {
    AirglowRequirements *requirements;
    check(airglow_requirements_new(&requirements, &error));
    check(airglow_conformance_require(requirements, &error));
    VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO, 0, "host", 0, 0, 0, VK_API_VERSION_1_3};
    VkInstanceCreateInfo instance_info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, 0, 0, &application, 0, 0, 0, 0};
    VkInstance instance;
    check(vkCreateInstance(&instance_info, nullptr, &instance));
    VkPhysicalDevice physical = nullptr;
    uint32_t one = 1;
    check(vkEnumeratePhysicalDevices(instance, &one, &physical));
    AirglowPhysicalDevice candidate = {sizeof candidate, 0, (AirglowFunction)vkGetInstanceProcAddr, integer(instance),
                                       integer(physical)};
    const float priority = 1;
    VkDeviceQueueCreateInfo queue_info = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, 0, 0, 0, 1, &priority};
    VkDeviceCreateInfo device_info = {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, 0, 0, 1, &queue_info, 0, 0, 0, 0, 0};
    check(airglow_requirements_patch(requirements, &candidate, VK_API_VERSION_1_3, (void **)&device_info.pNext, nullptr,
                                     &error));
    VkDevice device;
    check(vkCreateDevice(physical, &device_info, nullptr, &device));
    VkQueue queue;
    vkGetDeviceQueue(device, 0, 0, &queue);

    AirglowAdoptInfo adopt = {};
    adopt.struct_size = sizeof adopt, adopt.api_version = VK_API_VERSION_1_3;
    adopt.get_instance_proc_addr = candidate.get_instance_proc_addr, adopt.instance = integer(instance);
    adopt.physical_device = integer(physical), adopt.device = integer(device);
    adopt.device_create_info = &device_info;
    int checks = 0;
    AirglowConformanceInfo info = {sizeof info, 0, &adopt, integer(queue), report, &checks};
    uint32_t failures = 0;
    check(airglow_conformance_run(&info, &failures, &error));
    std::printf("%d checks, %u failures\n", checks, failures);
    airglow_requirements_drop(requirements);
    vkDestroyDevice(device, nullptr), vkDestroyInstance(instance, nullptr);
    return failures != 0 || checks == 0;
}

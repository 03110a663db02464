// A host in C++ that makes its own device and has the conformance kit check the library on it; honest, or with the fault
// that its argument names.
#define AIRGLOW_CONFORMANCE
#include "device.hpp"
#include <cstring>

static_assert(sizeof(AirglowConformanceInfo) == 40, "its size is that of the library");

static void report(void *user, const char *name, const char *failure) {
    std::printf("%s: %s\n", name, failure ? failure : "passed");
    ++*static_cast<int *>(user);
}

static bool is(const char *name, const char *wanted) { return std::strcmp(name, wanted) == 0; }

// A table of functions that has no memory to give.
static VkResult no_memory(VkDevice, const VkMemoryAllocateInfo *, const VkAllocationCallbacks *, VkDeviceMemory *) {
    return VK_ERROR_OUT_OF_DEVICE_MEMORY;
}
static AirglowFunction without_memory(uint64_t device, const char *name) {
    if (is(name, "vkAllocateMemory")) return (AirglowFunction)no_memory;
    return (AirglowFunction)vkGetDeviceProcAddr((VkDevice)device, name);
}

// A table of functions two of which do nothing.
static void no_dispatch(VkCommandBuffer, uint32_t, uint32_t, uint32_t) {}
static void no_draw(VkCommandBuffer, uint32_t, uint32_t, uint32_t, uint32_t) {}
static AirglowFunction without_work(uint64_t device, const char *name) {
    if (is(name, "vkCmdDispatch")) return (AirglowFunction)no_dispatch;
    if (is(name, "vkCmdDraw")) return (AirglowFunction)no_draw;
    return (AirglowFunction)vkGetDeviceProcAddr((VkDevice)device, name);
}

int main(int, char **arguments) {
    const char *fault = arguments[1];
    AirglowRequirements *requirements;
    check(airglow_requirements_new(&requirements, &error));
    check(airglow_conformance_require(requirements, &error));
    {
        const Device host(requirements);
        VkDeviceCreateInfo bare = host.info;
        bare.pNext = nullptr;
        AirglowAdoptInfo adopt = host.adopt();
        if (is(fault, "features")) adopt.device_create_info = &bare;
        if (is(fault, "memory")) adopt.get_device_proc_addr = (AirglowFunction)without_memory;
        if (is(fault, "work")) adopt.get_device_proc_addr = (AirglowFunction)without_work;
        VkQueue queue;
        vkGetDeviceQueue(host.device, 0, 0, &queue);
        int checks = 0;
        AirglowConformanceInfo info = {sizeof info, 0, &adopt, integer(queue), report, &checks};
        uint32_t failures = 0;
        check(airglow_conformance_run(&info, &failures, &error));
        std::printf("%d checks, %u failures\n", checks, failures);
    }
    airglow_requirements_drop(requirements);
}

// A Vulkan device that has what airglow asks for, and what is said of it when it is handed over.
#pragma once
#include <vulkan/vulkan.h>
#include "airglow.h"
#include "readable.hpp"

inline AirglowError error = {sizeof error, AIRGLOW_STATUS_OK, 0, 0, {}};
inline void check(AirglowStatus status) {
    if (status != AIRGLOW_STATUS_OK) std::fprintf(stderr, "airglow: %s\n", error.message), std::exit(1);
}
template <class T> uint64_t integer(T handle) { return (uint64_t)handle; }

struct Device {
    const float priority = 1;
    VkInstance instance;
    VkPhysicalDevice physical = nullptr;  // the first one; airglow_requirements_check says what it lacks
    VkDeviceQueueCreateInfo queue_info = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, 0, 0, 0, 1, &priority};
    VkDeviceCreateInfo info = {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, 0, 0, 1, &queue_info, 0, 0, 0, 0, 0};
    VkDevice device;

    explicit Device(AirglowRequirements *requirements) {
        VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO, 0, "host", 0, 0, 0, VK_API_VERSION_1_3};
        VkInstanceCreateInfo instance_info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, 0, 0, &application, 0, 0, 0, 0};
        check(vkCreateInstance(&instance_info, nullptr, &instance));
        uint32_t one = 1;
        check(vkEnumeratePhysicalDevices(instance, &one, &physical));
        AirglowPhysicalDevice candidate = {};
        candidate.struct_size = sizeof candidate, candidate.instance = integer(instance);
        candidate.get_instance_proc_addr = (AirglowFunction)vkGetInstanceProcAddr;
        candidate.physical_device = integer(physical);
        check(airglow_requirements_check(requirements, &candidate, nullptr, &error));
        check(airglow_requirements_patch(requirements, &candidate, VK_API_VERSION_1_3, (void **)&info.pNext, nullptr,
                                         &error));
        check(vkCreateDevice(physical, &info, nullptr, &device));
    }
    Device(const Device &) = delete;
    ~Device() { vkDestroyDevice(device, nullptr), vkDestroyInstance(instance, nullptr); }

    AirglowAdoptInfo adopt() const {
        AirglowAdoptInfo adopt = {};
        adopt.struct_size = sizeof adopt, adopt.api_version = VK_API_VERSION_1_3, adopt.frames_in_flight = 1;
        adopt.get_instance_proc_addr = (AirglowFunction)vkGetInstanceProcAddr, adopt.instance = integer(instance);
        adopt.physical_device = integer(physical), adopt.device = integer(device), adopt.device_create_info = &info;
        return adopt;
    }
};

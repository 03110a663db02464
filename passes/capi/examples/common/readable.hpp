// What every small Vulkan host has: a buffer that the CPU reads, and a command buffer that is submitted and waited for.
#pragma once
#include <vulkan/vulkan.h>
#include <cstdio>
#include <cstdlib>

inline void check(VkResult result) {
    if (result < 0) std::fprintf(stderr, "Vulkan returned %d\n", result), std::exit(1);
}

struct Readable {
    VkDevice device;
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    void *data = nullptr;

    Readable(VkPhysicalDevice physical, VkDevice device, VkDeviceSize size, VkBufferUsageFlags usage) : device(device) {
        VkBufferCreateInfo info = {};
        info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, info.size = size, info.usage = usage;
        check(vkCreateBuffer(device, &info, nullptr, &buffer));
        VkMemoryRequirements needed;
        vkGetBufferMemoryRequirements(device, buffer, &needed);
        VkPhysicalDeviceMemoryProperties has;
        vkGetPhysicalDeviceMemoryProperties(physical, &has);
        const uint32_t wanted = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
        uint32_t type = 0;
        while (!(needed.memoryTypeBits >> type & 1) || (has.memoryTypes[type].propertyFlags & wanted) != wanted) type++;
        VkMemoryAllocateInfo allocate = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needed.size, type};
        check(vkAllocateMemory(device, &allocate, nullptr, &memory));
        check(vkBindBufferMemory(device, buffer, memory, 0));
        check(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &data));
    }
    ~Readable() { vkDestroyBuffer(device, buffer, nullptr), vkFreeMemory(device, memory, nullptr); }
};

// Has `record` fill a command buffer, submits it to queue 0 of `family` and waits for it.
template <class Record> void submit(VkDevice device, uint32_t family, Record record) {
    VkCommandPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, family};
    VkCommandPool pool;
    check(vkCreateCommandPool(device, &pool_info, nullptr, &pool));
    VkCommandBufferAllocateInfo info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool,
                                        VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    VkCommandBuffer commands;
    check(vkAllocateCommandBuffers(device, &info, &commands));
    VkCommandBufferBeginInfo begin = {};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    check(vkBeginCommandBuffer(commands, &begin));
    record(commands);
    check(vkEndCommandBuffer(commands));
    VkSubmitInfo submission = {};
    submission.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submission.commandBufferCount = 1, submission.pCommandBuffers = &commands;
    VkQueue queue;
    vkGetDeviceQueue(device, family, 0, &queue);
    check(vkQueueSubmit(queue, 1, &submission, VK_NULL_HANDLE));
    check(vkQueueWaitIdle(queue));
    vkDestroyCommandPool(device, pool, nullptr);
}

// An image of the host's with memory of its own, its contents, and the host's barriers for it.
#pragma once
#include "device.hpp"

struct Image {
    VkDevice device;
    VkFormat format;
    VkExtent2D extent;
    VkImageUsageFlags usage;
    VkImageSubresourceRange range;
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;

    Image(VkDevice device, VkFormat format, VkExtent2D extent, VkImageUsageFlags usage, VkImageAspectFlags aspect)
        : device(device), format(format), extent(extent), usage(usage), range{aspect, 0, 1, 0, 1} {
        VkImageCreateInfo info = {};
        info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO, info.imageType = VK_IMAGE_TYPE_2D, info.format = format;
        info.extent = {extent.width, extent.height, 1}, info.mipLevels = 1, info.arrayLayers = 1;
        info.samples = VK_SAMPLE_COUNT_1_BIT, info.usage = usage;
        check(vkCreateImage(device, &info, nullptr, &image));
        VkMemoryRequirements needed;
        vkGetImageMemoryRequirements(device, image, &needed);
        uint32_t type = 0;
        while (!(needed.memoryTypeBits >> type & 1)) type++;
        VkMemoryAllocateInfo allocate = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needed.size, type};
        check(vkAllocateMemory(device, &allocate, nullptr, &memory));
        check(vkBindImageMemory(device, image, memory, 0));
    }
    Image(const Image &) = delete;
    ~Image() { vkDestroyImage(device, image, nullptr), vkFreeMemory(device, memory, nullptr); }

    VkBufferImageCopy whole() const {
        return {0, 0, 0, {range.aspectMask, 0, 0, 1}, {0, 0, 0}, {extent.width, extent.height, 1}};
    }
    AirglowBinding binding(uint32_t resource) const {
        AirglowBinding binding = {};
        binding.resource = resource, binding.image = integer(image), binding.usage = usage, binding.format = format;
        binding.extent[0] = extent.width, binding.extent[1] = extent.height;
        return binding;
    }
    // Into the state of a use, with the texels of a buffer or with none.
    void bring(VkCommandBuffer commands, const AirglowAccess &use, const Readable *texels) const {
        const VkImageLayout none = VK_IMAGE_LAYOUT_UNDEFINED, wanted = (VkImageLayout)use.layout;
        if (!texels) return barrier(commands, 0, 0, none, use.stage, use.access, wanted);
        const VkImageLayout written = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        const VkPipelineStageFlags2 copy = VK_PIPELINE_STAGE_2_COPY_BIT;
        const VkBufferImageCopy all = whole();
        barrier(commands, 0, 0, none, copy, VK_ACCESS_2_TRANSFER_WRITE_BIT, written);
        vkCmdCopyBufferToImage(commands, texels->buffer, image, written, 1, &all);
        barrier(commands, copy, VK_ACCESS_2_TRANSFER_WRITE_BIT, written, use.stage, use.access, wanted);
    }
    // From the state of a use into a buffer, for the host to read.
    void read(VkCommandBuffer commands, const AirglowAccess &use, const Readable &texels) const {
        const VkImageLayout wanted = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        const VkPipelineStageFlags2 copy = VK_PIPELINE_STAGE_2_COPY_BIT;
        const VkBufferImageCopy all = whole();
        barrier(commands, use.stage, use.access, (VkImageLayout)use.layout, copy, VK_ACCESS_2_TRANSFER_READ_BIT, wanted);
        vkCmdCopyImageToBuffer(commands, image, wanted, texels.buffer, 1, &all);
        VkMemoryBarrier2 barrier = {VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, copy, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                    VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};
        VkDependencyInfo dependency = {VK_STRUCTURE_TYPE_DEPENDENCY_INFO, nullptr, 0, 1, &barrier, 0, 0, 0, 0};
        vkCmdPipelineBarrier2(commands, &dependency);
    }
    void barrier(VkCommandBuffer commands, VkPipelineStageFlags2 from, VkAccessFlags2 written, VkImageLayout old_layout,
                 VkPipelineStageFlags2 to, VkAccessFlags2 used, VkImageLayout new_layout) const {
        VkImageMemoryBarrier2 barrier = {};
        barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2, barrier.image = image;
        barrier.srcStageMask = from, barrier.srcAccessMask = written, barrier.oldLayout = old_layout;
        barrier.dstStageMask = to, barrier.dstAccessMask = used, barrier.newLayout = new_layout;
        barrier.subresourceRange = range;
        VkDependencyInfo dependency = {VK_STRUCTURE_TYPE_DEPENDENCY_INFO, nullptr, 0, 0, nullptr, 0, nullptr, 1, &barrier};
        vkCmdPipelineBarrier2(commands, &dependency);
    }
};

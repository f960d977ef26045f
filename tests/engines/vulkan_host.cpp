// SPDX-License-Identifier: Apache-2.0
// Runs a compute shader of this folder on the first GPU, or else on the first other Vulkan device:
//
//     relief_vulkan_host glsl|hlsl SHADER.spv CASE ANSWERS [--time N]
//
// Reads a case of write_engine_cases.cpp and writes its answers. --time also runs N queries 20 times and prints the
// median time per query. Needs only libvulkan. VK_ICD_FILENAMES selects a driver.
#include <vulkan/vulkan.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace {

constexpr std::uint32_t kWidth = 2048;        // texels per row
constexpr std::size_t kTexel = 8;             // bytes
constexpr std::size_t kConstants = 80;        // bytes
constexpr std::size_t kQuery = 48;            // bytes
constexpr std::size_t kAnswer = 64;           // bytes
constexpr std::uint32_t kGroup = 64;          // queries per workgroup
constexpr std::uint32_t kGroupsMax = 65'535;  // of every device
constexpr int kRuns = 20;                     // of --time

[[noreturn]] void fail(const std::string& text) {
    std::fprintf(stderr, "relief_vulkan_host: %s\n", text.c_str());
    std::exit(1);
}

void check(VkResult result, const char* call) {
    if (result != VK_SUCCESS) {
        fail(std::string(call) + " returned " + std::to_string(result));
    }
}
#define CHECK(call) check(call, #call)

std::vector<char> readBytes(const char* path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        fail(std::string(path) + ": cannot be read");
    }
    return {std::istreambuf_iterator<char>(file), {}};
}

struct Case {
    std::uint32_t height = 0;
    std::uint32_t count = 0;
    std::vector<char> constants, texels, queries;
};

Case readCase(const char* path) {
    const std::vector<char> bytes = readBytes(path);
    Case one;
    std::array<std::uint32_t, 2> head{};
    if (bytes.size() < sizeof(head)) {
        fail(std::string(path) + ": is too short");
    }
    std::memcpy(head.data(), bytes.data(), sizeof(head));
    one.height = head[0];
    one.count = head[1];
    const char* at = bytes.data() + sizeof(head);
    const auto next = [&](std::size_t size) {
        if (size > static_cast<std::size_t>(bytes.data() + bytes.size() - at)) {
            fail(std::string(path) + ": is too short");
        }
        at += size;
        return std::vector<char>(at - size, at);
    };
    one.constants = next(kConstants);
    one.texels = next(kTexel * kWidth * one.height);
    one.queries = next(kQuery * one.count);
    return one;
}

VkInstance instance;
VkPhysicalDevice physical;
VkDevice device;
VkQueue queue;
VkCommandBuffer commands;
std::uint32_t family;
VkPhysicalDeviceProperties properties;

void openDevice() {
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.apiVersion = VK_API_VERSION_1_0;
    VkInstanceCreateInfo create{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    create.pApplicationInfo = &application;
    CHECK(vkCreateInstance(&create, nullptr, &instance));
    std::uint32_t count = 0;
    CHECK(vkEnumeratePhysicalDevices(instance, &count, nullptr));
    std::vector<VkPhysicalDevice> all(count);
    CHECK(vkEnumeratePhysicalDevices(instance, &count, all.data()));
    if (all.empty()) {
        fail("there is no Vulkan device");
    }
    physical = all[0];
    for (auto other = all.rbegin(); other != all.rend(); ++other) {
        vkGetPhysicalDeviceProperties(*other, &properties);
        physical = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU ? *other : physical;
    }
    vkGetPhysicalDeviceProperties(physical, &properties);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    while (family < count && (families[family].queueFlags & VK_QUEUE_COMPUTE_BIT) == 0) {
        ++family;
    }
    if (family == count) {
        fail(std::string(properties.deviceName) + " has no queue for compute shaders");
    }
    const float priority = 1.0F;
    VkDeviceQueueCreateInfo one{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    one.queueFamilyIndex = family;
    one.queueCount = 1;
    one.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &one;
    CHECK(vkCreateDevice(physical, &info, nullptr, &device));
    vkGetDeviceQueue(device, family, 0, &queue);
    VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool_info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool_info.queueFamilyIndex = family;
    VkCommandPool pool = VK_NULL_HANDLE;
    CHECK(vkCreateCommandPool(device, &pool_info, nullptr, &pool));
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = pool;
    allocate.commandBufferCount = 1;
    CHECK(vkAllocateCommandBuffers(device, &allocate, &commands));
}

VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags) {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    info.allocationSize = needs.size;
    while ((needs.memoryTypeBits >> info.memoryTypeIndex & 1U) == 0 ||
           (memory.memoryTypes[info.memoryTypeIndex].propertyFlags & flags) != flags) {
        if (++info.memoryTypeIndex == memory.memoryTypeCount) {
            fail("the device has no memory of a required type");
        }
    }
    VkDeviceMemory own = VK_NULL_HANDLE;
    CHECK(vkAllocateMemory(device, &info, nullptr, &own));
    return own;
}

struct Buffer {
    VkBuffer name = VK_NULL_HANDLE;
    void* mapped = nullptr;  // if the host sees it
    VkDeviceSize size = 0;
};

Buffer makeBuffer(VkDeviceSize size, bool host) {
    Buffer buffer{VK_NULL_HANDLE, nullptr, size};
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = size;
    info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                 VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
    CHECK(vkCreateBuffer(device, &info, nullptr, &buffer.name));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device, buffer.name, &needs);
    VkDeviceMemory memory =
        allocate(needs, host ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT
                             : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    CHECK(vkBindBufferMemory(device, buffer.name, memory, 0));
    if (host) {
        CHECK(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &buffer.mapped));
    }
    return buffer;
}

Buffer staged(const std::vector<char>& bytes) {
    Buffer buffer = makeBuffer(bytes.size(), true);
    std::memcpy(buffer.mapped, bytes.data(), bytes.size());
    return buffer;
}

void begin() {
    VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    CHECK(vkBeginCommandBuffer(commands, &info));
}

void submitAndWait() {
    CHECK(vkEndCommandBuffer(commands));
    VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    CHECK(vkQueueSubmit(queue, 1, &info, VK_NULL_HANDLE));
    CHECK(vkQueueWaitIdle(queue));
}

void copy(const Buffer& from, const Buffer& to) {
    begin();
    const VkBufferCopy region{0, 0, from.size};
    vkCmdCopyBuffer(commands, from.name, to.name, 1, &region);
    submitAndWait();
}

VkImageView makeTexture(const Case& one) {
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = VK_FORMAT_R16G16B16A16_UINT;
    info.extent = {kWidth, one.height, 1};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    VkImage image = VK_NULL_HANDLE;
    CHECK(vkCreateImage(device, &info, nullptr, &image));
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device, image, &needs);
    CHECK(vkBindImageMemory(device, image, allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT), 0));

    const Buffer texels = staged(one.texels);
    begin();
    VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0,
                         nullptr, 0, nullptr, 1, &barrier);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = info.extent;
    vkCmdCopyBufferToImage(commands, texels.name, image, barrier.newLayout, 1, &region);
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 0,
                         nullptr, 0, nullptr, 1, &barrier);
    submitAndWait();

    VkImageViewCreateInfo view_info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view_info.image = image;
    view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view_info.format = info.format;
    view_info.subresourceRange = barrier.subresourceRange;
    VkImageView view = VK_NULL_HANDLE;
    CHECK(vkCreateImageView(device, &view_info, nullptr, &view));
    return view;
}

/// The shader with its resources; bind() and dispatch.
class Program {
  public:
    /// \param separate  the texture has no sampler, as in HLSL.
    Program(const std::vector<char>& code, bool separate) {
        texture_type_ =
            separate ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        const VkDescriptorType types[] = {texture_type_, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                                          VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                          VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
        std::array<VkDescriptorSetLayoutBinding, 4> bindings{};
        std::array<VkDescriptorPoolSize, 4> sizes{};
        for (std::uint32_t i = 0; i < 4; ++i) {
            bindings[i] = {i, types[i], 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
            sizes[i] = {types[i], 2};
        }
        VkDescriptorSetLayoutCreateInfo set_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
        set_info.bindingCount = 4;
        set_info.pBindings = bindings.data();
        CHECK(vkCreateDescriptorSetLayout(device, &set_info, nullptr, &set_layout_));
        VkDescriptorPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
        pool_info.maxSets = 2;
        pool_info.poolSizeCount = 4;
        pool_info.pPoolSizes = sizes.data();
        CHECK(vkCreateDescriptorPool(device, &pool_info, nullptr, &pool_));
        VkPipelineLayoutCreateInfo layout_info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
        layout_info.setLayoutCount = 1;
        layout_info.pSetLayouts = &set_layout_;
        CHECK(vkCreatePipelineLayout(device, &layout_info, nullptr, &layout_));
        std::vector<std::uint32_t> words(code.size() / 4);
        std::memcpy(words.data(), code.data(), 4 * words.size());
        VkShaderModuleCreateInfo module_info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
        module_info.codeSize = 4 * words.size();
        module_info.pCode = words.data();
        VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
        info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
        info.stage.pName = "main";
        info.layout = layout_;
        CHECK(vkCreateShaderModule(device, &module_info, nullptr, &info.stage.module));
        CHECK(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_));
        VkSamplerCreateInfo sampler_info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
        CHECK(vkCreateSampler(device, &sampler_info, nullptr, &sampler_));
    }

    /// Selects resources and records their binding.
    void bind(VkImageView texture, const Buffer& constants, const Buffer& queries, const Buffer& answers) {
        if (set_ == VK_NULL_HANDLE || bound_ != queries.name) {
            VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
            info.descriptorPool = pool_;
            info.descriptorSetCount = 1;
            info.pSetLayouts = &set_layout_;
            CHECK(vkAllocateDescriptorSets(device, &info, &set_));
            bound_ = queries.name;
            const VkDescriptorImageInfo image{sampler_, texture, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
            const Buffer* const buffers[] = {&constants, &queries, &answers};
            for (std::uint32_t i = 0; i < 4; ++i) {
                VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
                write.dstSet = set_;
                write.dstBinding = i;
                write.descriptorCount = 1;
                VkDescriptorBufferInfo buffer{};
                if (i == 0) {
                    write.descriptorType = texture_type_;
                    write.pImageInfo = &image;
                } else {
                    write.descriptorType =
                        i == 1 ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
                    buffer = {buffers[i - 1]->name, 0, buffers[i - 1]->size};
                    write.pBufferInfo = &buffer;
                }
                vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
            }
        }
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set_, 0, nullptr);
    }

  private:
    VkDescriptorType texture_type_;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
    VkSampler sampler_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    VkBuffer bound_ = VK_NULL_HANDLE;
};

std::uint32_t groupsOf(std::uint32_t count) {
    const std::uint32_t groups = (count + kGroup - 1) / kGroup;
    if (count == 0 || groups > kGroupsMax) {
        fail("the number of queries is not 1 to " + std::to_string(kGroup * kGroupsMax));
    }
    return groups;
}

struct Inputs {
    VkImageView texture;
    Buffer constants;
    std::vector<char> queries;
};

std::vector<char> answersOf(Program& program, const Inputs& in, std::uint32_t count) {
    const Buffer queries = makeBuffer(in.queries.size(), false);
    copy(staged(in.queries), queries);
    const Buffer answers = makeBuffer(kAnswer * count, false);
    begin();
    program.bind(in.texture, in.constants, queries, answers);
    vkCmdDispatch(commands, groupsOf(count), 1, 1);
    submitAndWait();
    const Buffer back = makeBuffer(answers.size, true);
    copy(answers, back);
    const char* const bytes = static_cast<const char*>(back.mapped);
    return {bytes, bytes + back.size};
}

/// Returns the median time per query in nanoseconds.
double timeOf(Program& program, const Inputs& in, std::uint32_t count) {
    std::vector<char> repeated(kQuery * count);
    for (std::size_t at = 0; at < repeated.size(); at += in.queries.size()) {
        std::memcpy(&repeated[at], in.queries.data(), std::min(in.queries.size(), repeated.size() - at));
    }
    const Buffer queries = makeBuffer(repeated.size(), false);
    copy(staged(repeated), queries);
    const Buffer answers = makeBuffer(kAnswer * count, false);
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = 2;
    VkQueryPool pool = VK_NULL_HANDLE;
    CHECK(vkCreateQueryPool(device, &info, nullptr, &pool));
    std::array<double, kRuns> times{};
    for (double& time : times) {
        begin();
        vkCmdResetQueryPool(commands, pool, 0, 2);
        program.bind(in.texture, in.constants, queries, answers);
        vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, pool, 0);
        vkCmdDispatch(commands, groupsOf(count), 1, 1);
        vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, pool, 1);
        submitAndWait();
        std::array<std::uint64_t, 2> ticks{};
        CHECK(vkGetQueryPoolResults(device, pool, 0, 2, sizeof(ticks), ticks.data(), sizeof(ticks[0]),
                                    VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
        time = static_cast<double>(ticks[1] - ticks[0]) * double{properties.limits.timestampPeriod};
    }
    std::sort(times.begin(), times.end());
    return 0.5 * (times[kRuns / 2 - 1] + times[kRuns / 2]) / count;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string language = argc > 1 ? argv[1] : "";
    if ((argc != 5 && argc != 7) || (language != "glsl" && language != "hlsl") ||
        (argc == 7 && std::strcmp(argv[5], "--time") != 0)) {
        fail("usage: relief_vulkan_host glsl|hlsl SHADER.spv CASE ANSWERS [--time N]");
    }
    const Case one = readCase(argv[3]);
    openDevice();
    Program program(readBytes(argv[2]), language == "hlsl");
    const Inputs inputs{makeTexture(one), staged(one.constants), one.queries};
    const std::vector<char> answers = answersOf(program, inputs, one.count);
    std::ofstream file(argv[4], std::ios::binary);
    file.write(answers.data(), static_cast<std::streamsize>(answers.size()));
    if (!file.flush()) {
        fail(std::string(argv[4]) + ": cannot be written");
    }
    if (argc == 7) {
        const auto count = static_cast<std::uint32_t>(std::strtoul(argv[6], nullptr, 10));
        std::printf("%s: %.3f ns per query (median of %d runs of %u queries)\n", properties.deviceName,
                    timeOf(program, inputs, count), kRuns, count);
    } else {
        std::printf("%s\n", properties.deviceName);
    }
    return 0;
}

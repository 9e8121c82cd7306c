/* Runs the program of `microfacet-bake export spirv --gamma 3` on the first device of Vulkan: takes
 * the folder of the export, reflects the view of `clients/c/lookup.c`, and prints the same lines.
 * Exit status 1 if the device fails. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vulkan.h>

/* As the program declares them; the offset of a first shape is 0. */
typedef struct query {
    float v[3];
    uint32_t shape;
    float sigma[2], u[2];
} query;
typedef struct answer {
    float l[3], weight, m[3], pdf, f, albedo, average, masking;
} answer;

static VkDevice device;
static VkPhysicalDevice physical;

static void check(VkResult result, const char *what)
{
    if (result == VK_SUCCESS) return;
    fprintf(stderr, "error: %s: %d\n", what, result);
    exit(1);
}

static void *read_file(const char *folder, const char *name, size_t *size)
{
    char path[4096];
    void *bytes;
    FILE *file;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    file = fopen(path, "rb");
    if (!file || fseek(file, 0, SEEK_END)) {
        fprintf(stderr, "error: %s: cannot be read\n", path);
        exit(1);
    }
    *size = (size_t)ftell(file);
    rewind(file);
    bytes = malloc(*size);
    if (!bytes || fread(bytes, 1, *size, file) != *size) exit(1);
    fclose(file);
    return bytes;
}

/* A storage buffer that host and device see, filled if there is something to fill it with. */
static VkBuffer storage(const void *bytes, size_t size, void **mapped)
{
    VkBufferCreateInfo info = {VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    VkMemoryAllocateInfo allocation = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    const VkMemoryPropertyFlags wanted =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkPhysicalDeviceMemoryProperties types;
    VkMemoryRequirements needs;
    VkDeviceMemory memory;
    VkBuffer buffer;
    uint32_t i = 0;
    info.size = size;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    check(vkCreateBuffer(device, &info, NULL, &buffer), "a buffer");
    vkGetBufferMemoryRequirements(device, buffer, &needs);
    vkGetPhysicalDeviceMemoryProperties(physical, &types);
    while (!(needs.memoryTypeBits >> i & 1) ||
           (types.memoryTypes[i].propertyFlags & wanted) != wanted)
        ++i;
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = i;
    check(vkAllocateMemory(device, &allocation, NULL, &memory), "memory");
    check(vkBindBufferMemory(device, buffer, memory, 0), "memory");
    check(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, mapped), "memory");
    if (bytes) memcpy(*mapped, bytes, size);
    return buffer;
}

static void start(void)
{
    VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO};
    VkInstanceCreateInfo info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    VkDeviceQueueCreateInfo queue = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    VkDeviceCreateInfo device_info = {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    const float priority = 1.0f;
    VkInstance instance;
    uint32_t one = 1;
    VkResult found;
    application.apiVersion = VK_API_VERSION_1_1;
    info.pApplicationInfo = &application;
    check(vkCreateInstance(&info, NULL, &instance), "an instance");
    found = vkEnumeratePhysicalDevices(instance, &one, &physical);
    if (one == 0) found = VK_ERROR_INITIALIZATION_FAILED;
    check(found == VK_INCOMPLETE ? VK_SUCCESS : found, "a device");
    queue.queueCount = 1; /* of the first family, which computes on all common devices */
    queue.pQueuePriorities = &priority;
    device_info.queueCreateInfoCount = 1;
    device_info.pQueueCreateInfos = &queue;
    check(vkCreateDevice(physical, &device_info, NULL, &device), "a device");
}

/* Runs the module over three buffers, the tables first, with one workgroup. */
static void run(const uint32_t *words, size_t size, const VkBuffer buffers[3])
{
    VkDescriptorSetLayoutBinding bindings[3] = {{0}};
    VkDescriptorSetLayoutCreateInfo set_info = {
        VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    VkPipelineLayoutCreateInfo layout_info = {VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    VkShaderModuleCreateInfo module_info = {VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    VkComputePipelineCreateInfo pipeline_info = {VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    VkDescriptorPoolSize pool_size = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 3};
    VkDescriptorPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    VkDescriptorSetAllocateInfo sets_info = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    VkCommandPoolCreateInfo commands_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    VkCommandBufferAllocateInfo buffer_info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    VkCommandBufferBeginInfo begin = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    VkMemoryBarrier barrier = {VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    VkSubmitInfo submit = {VK_STRUCTURE_TYPE_SUBMIT_INFO};
    VkDescriptorBufferInfo whole[3];
    VkWriteDescriptorSet write = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkShaderModule module;
    VkPipeline pipeline;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkCommandPool commands;
    VkCommandBuffer command;
    VkQueue queue;
    uint32_t i;

    for (i = 0; i < 3; ++i) {
        bindings[i].binding = i;
        bindings[i].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        bindings[i].descriptorCount = 1;
        bindings[i].stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
        whole[i].buffer = buffers[i];
        whole[i].offset = 0;
        whole[i].range = VK_WHOLE_SIZE;
    }
    set_info.bindingCount = 3;
    set_info.pBindings = bindings;
    check(vkCreateDescriptorSetLayout(device, &set_info, NULL, &set_layout), "bindings");
    layout_info.setLayoutCount = 1;
    layout_info.pSetLayouts = &set_layout;
    check(vkCreatePipelineLayout(device, &layout_info, NULL, &layout), "bindings");

    module_info.codeSize = size;
    module_info.pCode = words;
    check(vkCreateShaderModule(device, &module_info, NULL, &module), "student_t.spv");
    pipeline_info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    pipeline_info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    pipeline_info.stage.module = module;
    pipeline_info.stage.pName = "reflect_views";
    pipeline_info.layout = layout;
    check(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &pipeline_info, NULL, &pipeline),
          "the pipeline");

    pool_info.maxSets = 1;
    pool_info.poolSizeCount = 1;
    pool_info.pPoolSizes = &pool_size;
    check(vkCreateDescriptorPool(device, &pool_info, NULL, &pool), "descriptors");
    sets_info.descriptorPool = pool;
    sets_info.descriptorSetCount = 1;
    sets_info.pSetLayouts = &set_layout;
    check(vkAllocateDescriptorSets(device, &sets_info, &set), "descriptors");
    write.dstSet = set;
    write.descriptorCount = 3; /* bindings 0, 1 and 2 */
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    write.pBufferInfo = whole;
    vkUpdateDescriptorSets(device, 1, &write, 0, NULL);

    check(vkCreateCommandPool(device, &commands_info, NULL, &commands), "commands");
    buffer_info.commandPool = commands;
    buffer_info.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(device, &buffer_info, &command), "commands");
    check(vkBeginCommandBuffer(command, &begin), "commands");
    vkCmdBindPipeline(command, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdBindDescriptorSets(command, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, NULL);
    vkCmdDispatch(command, 1, 1, 1);
    /* What the shader wrote is made visible to the host. */
    barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
    vkCmdPipelineBarrier(command, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                         0, 1, &barrier, 0, NULL, 0, NULL);
    check(vkEndCommandBuffer(command), "commands");
    vkGetDeviceQueue(device, 0, 0, &queue);
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &command;
    check(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE), "a submission");
    check(vkDeviceWaitIdle(device), "a submission");
}

int main(int count, char **arguments)
{
    const query q = {{0.6f, 0.0f, 0.8f}, 0, {0.3f, 0.3f}, {0.2f, 0.7f}};
    size_t words_size, tables_size;
    void *words, *tables, *mapped;
    VkBuffer buffers[3];
    answer a;
    if (count != 2) {
        fprintf(stderr, "usage: vulkan FOLDER\n");
        return 2;
    }
    words = read_file(arguments[1], "student_t.spv", &words_size);
    tables = read_file(arguments[1], "student_t.bin", &tables_size);
    start();
    buffers[0] = storage(tables, tables_size, &mapped);
    buffers[1] = storage(&q, sizeof q, &mapped);
    buffers[2] = storage(NULL, sizeof a, &mapped);
    run(words, words_size, buffers);
    memcpy(&a, mapped, sizeof a);
    printf("light %.4f %.4f %.4f, f cos / pdf %.4f, pdf %.4f per steradian\n", (double)a.l[0],
           (double)a.l[1], (double)a.l[2], (double)a.weight, (double)a.pdf);
    printf("of all light one bounce returns %.4f\n", (double)a.albedo);
    return 0;
}

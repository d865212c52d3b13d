/* Between the files of src/gpu only. */
#ifndef TURNER_GPU_INTERNAL_H
#define TURNER_GPU_INTERNAL_H

#include "gpu/device.h"

/* The device extensions of `physical`, less those in TURNER_MASK_EXTENSIONS. */
struct turner_extensions {
    VkExtensionProperties *items;
    uint32_t count;
};
enum turner_result turner_extensions_create(struct turner_extensions *extensions,
                                            VkPhysicalDevice physical);
void turner_extensions_destroy(struct turner_extensions *extensions);
bool turner_extensions_have(const struct turner_extensions *extensions, const char *name);

/* The extensions that ray queries need. */
extern const char *const turner_ray_query_extensions[];
extern const uint32_t turner_ray_query_extension_count;

/* The first queue family that computes, or UINT32_MAX. Its timestamp bits in *timestamp_bits. */
uint32_t turner_queue_family(VkPhysicalDevice physical, uint32_t *timestamp_bits);

/* What a device is and can do. */
enum turner_result turner_gpu_describe(struct turner_gpu_info *info, VkPhysicalDevice physical);

/* The validation layer: whether the loader has it, and the messenger to give to vkCreateInstance
 * and vkCreateDebugUtilsMessengerEXT. */
#define TURNER_VALIDATION_LAYER "VK_LAYER_KHRONOS_validation"
bool turner_validation_available(void);
VkDebugUtilsMessengerCreateInfoEXT turner_validation_messenger(void);

#endif

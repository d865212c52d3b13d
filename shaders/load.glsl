// What stands in the scene's arrays. A load through an address is a gather for each of its parts,
// which costs time and, where the processor has none, much code; in words of 64 bits there are half
// as many. Parts that are not asked for are not loaded.
#define TURNER_BLOCK(block, type)                                                                  \
    layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer block             \
    {                                                                                              \
        type the;                                                                                  \
    }

TURNER_BLOCK(primitive_block, turner_gpu_primitive);
TURNER_BLOCK(plane_block, turner_gpu_plane);
TURNER_BLOCK(material_block, turner_gpu_material);
TURNER_BLOCK(light_block, turner_gpu_light);
TURNER_BLOCK(instance_block, turner_gpu_instance);
TURNER_BLOCK(instance_rest_block, turner_gpu_instance_rest);

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer word_array
{
    uint64_t at[];
};

uvec2 word_at(uint64_t address, uint i)
{
    return unpackUint2x32(word_array(address).at[i]);
}

vec2 two_at(uint64_t address, uint i)
{
    return uintBitsToFloat(word_at(address, i));
}

// Two vectors in three words.
vec3[2] vectors_at(uint64_t address, uint i)
{
    vec2 a = two_at(address, i), b = two_at(address, i + 1u), c = two_at(address, i + 2u);
    return vec3[2](vec3(a, b.x), vec3(b.y, c));
}

// A vector in two words, and what stands behind it.
vec3 vector_at(uint64_t address, uint i, out uint behind)
{
    uvec2 b = word_at(address, i + 1u);
    behind = b.y;
    return vec3(two_at(address, i), uintBitsToFloat(b.x));
}

turner_gpu_primitive primitive_of(uint index)
{
    uint64_t at = uint64_t(primitive_block(scene.primitives) + index);
    uint id;
    vec3 ab[2] = vectors_at(at, 0u), c = vector_at(at, 3u, id);
    uvec2 rest = word_at(at, 5u);
    return turner_gpu_primitive(ab[0], ab[1], c, id, rest.x, rest.y);
}

turner_gpu_plane plane_of(uint index)
{
    uint64_t at = uint64_t(plane_block(scene.planes) + index);
    uint material, pad;
    vec3 places[2] = vectors_at(at, 0u), tangent = vector_at(at, 3u, material);
    vec3 rests[2] = vectors_at(at, 5u), tangent_rest = vector_at(at, 8u, pad);
    return turner_gpu_plane(places[0], places[1], tangent, material, rests[0], rests[1],
                            tangent_rest, pad);
}

turner_gpu_material material_of(uint index)
{
    uint64_t at = uint64_t(material_block(scene.materials) + index);
    vec3 k_ea[2] = vectors_at(at, 0u), k_ds[2] = vectors_at(at, 3u), k_rt[2] = vectors_at(at, 6u);
    vec3 metal[2] = vectors_at(at, 9u), checker[2] = vectors_at(at, 12u);
    uvec2 a = word_at(at, 16u), b = word_at(at, 17u), c = word_at(at, 18u);
    return turner_gpu_material(k_ea[0], k_ea[1], k_ds[0], k_ds[1], k_rt[0], k_rt[1], metal[0],
                               metal[1], checker[0], checker[1], two_at(at, 15u),
                               uintBitsToFloat(a.x), a.y, b.x, b.y, c.x, c.y);
}

turner_gpu_light light_of(uint index)
{
    uint64_t at = uint64_t(light_block(scene.lights) + index);
    uint kind;
    vec3 places[2] = vectors_at(at, 0u), power = vector_at(at, 3u, kind);
    uvec2 a = word_at(at, 5u), b = word_at(at, 6u);
    vec3 rests[2] = vectors_at(at, 7u);
    return turner_gpu_light(places[0], places[1], power, kind, a.x, uintBitsToFloat(a.y),
                            uintBitsToFloat(b.x), b.y, rests[0], rests[1]);
}

// A map of an instance; `rest` only where the kernel computes in double.
real[12] map_at(uint64_t address, uint64_t rest)
{
    real m[12];
    for (uint i = 0u; i < 6u; i++) {
        vec2 two = two_at(address, i);
        m[2u * i] = EXACT(real, two.x, two_at(rest, i).x);
        m[2u * i + 1u] = EXACT(real, two.y, two_at(rest, i).y);
    }
    return m;
}

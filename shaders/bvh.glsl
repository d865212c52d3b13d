// Our own bounding volume hierarchy (src/bvh), walked by each lane for itself. A node is loaded as
// eight 64-bit words, which lavapipe turns into real gathers.
#include "boxes.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer node_words
{
    uint64_t word[8];
};

// Set on a stack entry that is an instance of the top level, to be entered.
const uint SENTINEL = 0xffffffffu; // below it the rest of the top level waits

void traverse(inout search_t search, ray_t ray)
{
    uint stack[BVH_STACK];
    uint height = 0;
    uint instance = 0u;
    uint override_material = TURNER_NO_INDEX;
    bool top = NEEDS_ANY(TURNER_NEEDS_INSTANCES);
    instance_array instances = instance_array(scene.instances);
    uint node = scene.root;
    real3 origin = ray.origin, direction = ray.direction;
    boxes_ray_t boxes = boxes_ray_of(origin, direction);
    shear_t shear = shear_of(direction);

    for (uint visit = 0; visit < scene.max_visits; visit++) {
        node_words words = node_words(scene.nodes + uint64_t(node) * 64ul);
        vec2 w0 = uintBitsToFloat(unpackUint2x32(words.word[0]));
        vec2 w1 = uintBitsToFloat(unpackUint2x32(words.word[1]));
        vec2 w2 = uintBitsToFloat(unpackUint2x32(words.word[2]));
        vec2 w3 = uintBitsToFloat(unpackUint2x32(words.word[3]));
        vec2 w4 = uintBitsToFloat(unpackUint2x32(words.word[4]));
        vec2 w5 = uintBitsToFloat(unpackUint2x32(words.word[5]));
        uvec2 child = unpackUint2x32(words.word[6]);
        uvec2 count = unpackUint2x32(words.word[7]);
        int t_max = bits_of(search.hit.t);
        int enter0 = enter_box(boxes, vec3(w0, w1.x), vec3(w1.y, w2), t_max);
        int enter1 = enter_box(boxes, vec3(w3, w4.x), vec3(w4.y, w5), t_max);

        // leaves now, nearer or not; nodes later
        uint next = SENTINEL, other = SENTINEL;
        for (uint side = 0; side < 2; side++) {
            int enter = side == 0 ? enter0 : enter1;
            uint first = side == 0 ? child.x : child.y;
            uint items = side == 0 ? count.x : count.y;
            if (enter < 0 || (first | items) == 0u)
                continue; // missed, or no child there: node 0 is nobody's child
            if (items != 0u && !top) {
                for (uint i = 0; i < items && !search.blocked; i++)
                    intersect_primitive(search, primitive_of(first + i),
                                        first + i, instance, override_material, origin, direction,
                                        shear);
            } else {
                // an instance waits on the stack like a node, marked by its top bit
                uint entry = items != 0u ? first | 0x80000000u : first;
                if (next == SENTINEL) {
                    next = entry;
                } else {
                    bool swap = enter1 < enter0;
                    other = swap ? next : entry;
                    next = swap ? entry : next;
                }
            }
        }
        if (search.blocked)
            return;
        if (other != SENTINEL)
            stack[height++] = other;

        // go on with the nearer child, or with what waits
        if (next == SENTINEL) {
            if (height == 0u)
                return;
            next = stack[--height];
            if (NEEDS_ANY(TURNER_NEEDS_INSTANCES) && next == SENTINEL) {
                top = true; // the group is done: back to the world
                origin = ray.origin;
                direction = ray.direction;
                boxes = boxes_ray_of(origin, direction);
                if (height == 0u)
                    return;
                next = stack[--height];
            }
        }
        if (NEEDS_ANY(TURNER_NEEDS_INSTANCES) && top && (next & 0x80000000u) != 0u) {
            instance = next & 0x7fffffffu;
            real[12] to_group = to_group_of(instance);
            override_material = instances.at[instance].material;
            origin = transform_point(to_group, ray.origin);
            direction = transform_vector(to_group, ray.direction);
            boxes = boxes_ray_of(origin, direction);
            shear = shear_of(direction);
            stack[height++] = SENTINEL;
            top = false;
            next = instances.at[instance].root;
        }
        node = next;
    }
}
